// SPDX-License-Identifier: GPL-3.0-or-later
#include "asset/commands.h"

#include <charconv>
#include <cmath>

#include "common/error.h"

namespace knead::tools {
namespace {

double parse_tolerance(const std::string& text, const std::string& whole) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value) || value < 0)
        fail_usage("\"" + whole + "\" is not a tolerance: a number >= 0, or DATASET=NUMBER");
    return value;
}

void apply(const std::vector<std::string>& texts, double Tolerance::*member, CompareOptions& options) {
    for (const std::string& text : texts) {
        const std::size_t equals = text.rfind('=');
        if (equals == std::string::npos)
            options.tolerance.*member = parse_tolerance(text, text);
        else
            options.dataset_tolerance[text.substr(0, equals)].*member =
                parse_tolerance(text.substr(equals + 1), text);
    }
}

}  // namespace

CompareOptions compare_options(const std::vector<std::string>& absolute,
                               const std::vector<std::string>& relative) {
    CompareOptions options;
    apply(absolute, &Tolerance::absolute, options);
    apply(relative, &Tolerance::relative, options);
    return options;
}

const char* name_of(ErrorCode code) {
    switch (code) {
        case ErrorCode::io_error:
            return "io_error";
        case ErrorCode::not_knead:
            return "not_knead";
        case ErrorCode::version_unsupported:
            return "version_unsupported";
        case ErrorCode::feature_unsupported:
            return "feature_unsupported";
        case ErrorCode::wrong_kind:
            return "wrong_kind";
        case ErrorCode::missing:
            return "missing";
        case ErrorCode::wrong_type:
            return "wrong_type";
        case ErrorCode::wrong_extent:
            return "wrong_extent";
        case ErrorCode::too_large:
            return "too_large";
        case ErrorCode::forbidden:
            return "forbidden";
        case ErrorCode::corrupt:
            return "corrupt";
        case ErrorCode::invalid_data:
            return "invalid_data";
        case ErrorCode::cannot_write:
            return "cannot_write";
        case ErrorCode::out_of_memory:
            return "out_of_memory";
        case ErrorCode::invalid_argument:
            return "invalid_argument";
    }
    return "unknown";
}

std::string issue_line(const Error& error) {
    return (error.where.empty() ? "" : error.where + ": ") + name_of(error.code) + ": " + error.message;
}

}  // namespace knead::tools
