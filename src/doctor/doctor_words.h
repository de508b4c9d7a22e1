// SPDX-License-Identifier: MIT
// The fixed words of each kind of finding.
#ifndef ALPI_DOCTOR_DOCTOR_WORDS_H
#define ALPI_DOCTOR_DOCTOR_WORDS_H

#include <alpenglow/doctor.h>

/// Severity, code, visible effect and advice of a kind of finding.
typedef struct alpi_finding_words {
    alp_finding_kind kind;
    alp_severity severity;
    const char *code, *seen, *todo;
} alpi_finding_words;
const alpi_finding_words *alpi_finding_words_of(alp_finding_kind kind);
/// The words of the message with this code; those of ALP_FINDING_MESSAGE where there are none.
const alpi_finding_words *alpi_finding_words_by_code(const char *code);

#endif
