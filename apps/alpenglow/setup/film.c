// SPDX-License-Identifier: MIT
// Options of development: --exposure, --tone and --white-balance.
#include "setup/film.h"

int film_refuse(const command_line *a, const char *output)
{
    static const struct {
        option_id id;
        const char *name;
    } of_film[] = {{OPTION_EXPOSURE, "--exposure"},
                   {OPTION_TONE, "--tone"},
                   {OPTION_WHITE_BALANCE, "--white-balance"}};
    for (size_t i = 0; i < sizeof of_film / sizeof *of_film; i++) {
        if (a->values[of_film[i].id].given) {
            return usage_error(a->command,
                               "%s: applies to .png only, and %s holds linear values; give -o "
                               "IMAGE.png",
                               of_film[i].name, output);
        }
    }
    return EXIT_DONE;
}

alp_film_options film_read(const command_line *a, alp_render_method method)
{
    enum { BALANCE_AUTO = 0 }; // of the choices of --white-balance, auto and off
    const option_value *exposure = &a->values[OPTION_EXPOSURE];
    const option_value *balance = &a->values[OPTION_WHITE_BALANCE];
    const bool multipliers =
        method == ALP_RENDER_HEMICUBE && a->values[OPTION_SHOW].choice >= (int)ALP_HEMICUBE_WEIGHT;
    alp_film_options film =
        multipliers ? alp_film_options_default() : alp_render_film_options(method);
    if (exposure->given) {
        film.auto_exposure = exposure->choice >= 0;
        film.exposure = film.auto_exposure ? 0.0 : exposure->real;
    }
    if (a->values[OPTION_TONE].given) {
        film.tone = (alp_tone)a->values[OPTION_TONE].choice;
    }
    if (balance->choice < 0) {
        film.white_balance = ALP_WHITE_BALANCE_KELVIN;
        film.kelvin = (float)balance->real;
    } else if (balance->choice == BALANCE_AUTO) {
        film.white_balance = ALP_WHITE_BALANCE_AUTO;
    }
    return film;
}
