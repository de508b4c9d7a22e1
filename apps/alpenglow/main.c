// SPDX-License-Identifier: MIT
// The main program.
#include "dispatch.h"
#include "streams.h"

int main(int count, char **words)
{
    streams_open();
    return streams_close(command_dispatch(count > 0 ? count - 1 : 0, words + 1));
}
