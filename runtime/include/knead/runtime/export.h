// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks what the shared runtime library offers; everything else in it is hidden.
#if defined(_WIN32)
#if defined(KNEAD_RUNTIME_BUILD)
#define KNEAD_RUNTIME_API __declspec(dllexport)
#else
#define KNEAD_RUNTIME_API __declspec(dllimport)
#endif
#else
#define KNEAD_RUNTIME_API __attribute__((visibility("default")))
#endif
