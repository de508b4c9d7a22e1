// SPDX-License-Identifier: MIT
// Visibility of symbols: the shared library exports everything marked ALP_API and nothing else.
#ifndef ALPENGLOW_EXPORT_H
#define ALPENGLOW_EXPORT_H

#if defined(__GNUC__)
#define ALP_API __attribute__((visibility("default")))
#define ALP_NODISCARD __attribute__((warn_unused_result))
#define ALP_PRINTF(format_index, first_argument)                                                   \
    __attribute__((format(printf, format_index, first_argument)))
#else
#define ALP_API
#define ALP_NODISCARD
#define ALP_PRINTF(format_index, first_argument)
#endif

#ifdef __cplusplus
#define ALP_BEGIN_DECLS extern "C" {
#define ALP_END_DECLS }
#else
#define ALP_BEGIN_DECLS
#define ALP_END_DECLS
#endif

#endif
