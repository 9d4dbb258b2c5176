// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks what the shared haptics library offers; everything else in it is hidden.
#if defined(_WIN32)
#if defined(KNEAD_HAPTICS_BUILD)
#define KNEAD_HAPTICS_API __declspec(dllexport)
#else
#define KNEAD_HAPTICS_API __declspec(dllimport)
#endif
#else
#define KNEAD_HAPTICS_API __attribute__((visibility("default")))
#endif
