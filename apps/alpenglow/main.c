// SPDX-License-Identifier: MIT
#include <alpenglow/alpenglow.h>

#include <stdio.h>

int main(void)
{
    printf("alpenglow %s\n", alp_version());
    return 0;
}
