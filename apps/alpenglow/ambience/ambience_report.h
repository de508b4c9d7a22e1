// SPDX-License-Identifier: MIT
// The seconds of a flight as table, CSV and JSON.
#ifndef COMMAND_AMBIENCE_REPORT_H
#define COMMAND_AMBIENCE_REPORT_H

#include "ambience/flight_run.h"

#include <jansson.h>

/// One second of a flight.
typedef struct ambience_second {
    uint32_t number;         // from 1
    double time;             // of its last frame, seconds of the flight
    double position[3];      // of the camera then, in the world of the file
    alp_ambience_info info;  // of the volume then
    uint32_t frames;         // in it
    uint64_t samples, relit; // anchors, in it
    uint64_t rays;
    double sampling;  // seconds of the clock, of sampling alone
    double update_ms; // mean of a frame
    double worst_ms;
    double error; // percent; NAN = not measured
} ambience_second;

typedef struct ambience_record {
    uint32_t count;
    ambience_second *seconds; // [count]
} ambience_record;

void ambience_print_csv_names(FILE *stream);
void ambience_print_csv(FILE *stream, const ambience_second *second);
void ambience_print_names(void);
void ambience_print_second(const ambience_second *second);
void ambience_print_summary(const ambience_record *record);
/// The document, or NULL when memory ran out. The caller releases it.
json_t *ambience_json(const flight_run *run, const command_line *arguments,
                      const ambience_record *record);

#endif
