// SPDX-License-Identifier: MIT
// Linear values from 0 to 1 as a screen shows them: film with nothing in front of it.
#include <alpenglow/display.h>
#include <alpenglow/film.h>

alp_result alp_image_to_display(const alp_image *linear, alp_image **display)
{
    return alp_film_develop(linear, NULL, display, NULL);
}
