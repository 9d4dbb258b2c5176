// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/compare.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "load.h"
#include "number_text.h"

namespace knead {
namespace {

bool is_float(const Value& value) {
    return value.type == ScalarType::f32 || value.type == ScalarType::f64;
}

double number_at(const Value& value, std::size_t index) {
    return with_element(value, index, [](auto element) { return static_cast<double>(element); });
}

bool within(double a, double b, const Tolerance& tolerance) {
    return a == b ||
           std::abs(a - b) <= tolerance.absolute + tolerance.relative * std::max(std::abs(a), std::abs(b));
}

bool same_element(const Value& a, const Value& b, std::size_t i, const Tolerance& tolerance) {
    if (a.type == ScalarType::text) return a.text(i) == b.text(i);
    if (std::memcmp(a.bytes.data() + i * a.element_bytes, b.bytes.data() + i * a.element_bytes,
                    a.element_bytes) == 0)
        return true;  // the same NaN, too
    return is_float(a) && within(number_at(a, i), number_at(b, i), tolerance);
}

/// " at [4, 2]" for a flat index; nothing for a scalar.
std::string position_text(const Value& value, std::size_t index) {
    if (value.extents.empty()) return "";
    std::string text;
    for (std::size_t axis = value.extents.size(); axis-- > 0;) {
        text = std::to_string(index % value.extents[axis]) + (text.empty() ? "" : ", ") + text;
        index /= value.extents[axis];
    }
    return " at [" + text + "]";
}

class Comparison {
  public:
    explicit Comparison(const CompareOptions& options) : options_(options) {}

    std::vector<Difference> run(const Payload& a, const Payload& b) {
        std::set<std::string> paths;
        for (const auto& [path, node] : a.nodes)
            paths.insert(path);
        for (const auto& [path, node] : b.nodes)
            paths.insert(path);
        for (const std::string& path : paths) {
            const auto in_a = a.nodes.find(path), in_b = b.nodes.find(path);
            if (in_a == a.nodes.end() || in_b == b.nodes.end())
                add(path,
                    std::string("only in the ") + (in_b == b.nodes.end() ? "first" : "second") + " file");
            else
                compare(path, in_a->second, in_b->second);
        }
        return std::move(differences_);
    }

  private:
    void add(const std::string& path, const std::string& message, std::uint64_t count = 0,
             double largest = 0) {
        differences_.push_back({path, message, count, largest});
    }

    void compare(const std::string& path, const Node& a, const Node& b) {
        if (a.is_group != b.is_group) return add(path, "a group in one file, a dataset in the other");
        compare_attributes(path, a, b);
        if (!a.is_group) compare(path, a.value, b.value, tolerance_of(path));
    }

    void compare_attributes(const std::string& path, const Node& a, const Node& b) {
        std::set<std::string> names;
        for (const auto& [name, value] : a.attributes)
            names.insert(name);
        for (const auto& [name, value] : b.attributes)
            names.insert(name);
        for (const std::string& name : names) {
            const auto in_a = a.attributes.find(name), in_b = b.attributes.find(name);
            if (in_a == a.attributes.end() || in_b == b.attributes.end())
                add(path + "@" + name, "only in one file");
            else
                compare(path + "@" + name, in_a->second, in_b->second, {});
        }
    }

    void compare(const std::string& path, const Value& a, const Value& b, const Tolerance& tolerance) {
        if (a.type != b.type || a.extents != b.extents)
            return add(path, a.shape_text() + " in the first file, " + b.shape_text() + " in the second");
        std::uint64_t count = 0;
        std::size_t first = 0;
        double largest = 0;
        for (std::size_t i = 0; i < a.count(); ++i) {
            if (same_element(a, b, i, tolerance)) continue;
            if (count++ == 0) first = i;
            if (a.type != ScalarType::text)
                largest = std::max(largest, std::abs(number_at(a, i) - number_at(b, i)));
        }
        if (count == 0) return;
        std::string message = std::to_string(count) + " of " + std::to_string(a.count()) +
                              " values differ, first" + position_text(a, first) + ": " +
                              element_text(a, first) + " and " + element_text(b, first);
        if (a.type != ScalarType::text) message += "; largest difference " + number_text(largest);
        add(path, message, count, largest);
    }

    Tolerance tolerance_of(const std::string& path) const {
        auto found = options_.dataset_tolerance.find(path);
        if (found == options_.dataset_tolerance.end())
            found = options_.dataset_tolerance.find(path.substr(path.rfind('/') + 1));
        return found == options_.dataset_tolerance.end() ? options_.tolerance : found->second;
    }

    const CompareOptions& options_;
    std::vector<Difference> differences_;
};

void check_tolerance(const Tolerance& tolerance, const std::string& where) {
    const auto valid = [](double t) { return std::isfinite(t) && t >= 0; };
    if (!valid(tolerance.absolute) || !valid(tolerance.relative))
        fail(ErrorCode::invalid_argument, "a tolerance is not finite and >= 0", where);
}

/// A misspelt name would otherwise loosen or tighten nothing without a word.
void check_options(const CompareOptions& options, const Payload& a, const Payload& b) {
    check_tolerance(options.tolerance, "");
    for (const auto& [name, tolerance] : options.dataset_tolerance) {
        check_tolerance(tolerance, name);
        bool used = false;
        for (const Payload* payload : {&a, &b})
            for (const auto& [path, node] : payload->nodes)
                used = used || (!node.is_group && (path == name || path.substr(path.rfind('/') + 1) == name));
        if (!used) fail(ErrorCode::invalid_argument, "no dataset of this name in either file", name);
    }
}

}  // namespace

Result<std::vector<Difference>> compare_files(const std::filesystem::path& a, const std::filesystem::path& b,
                                              const CompareOptions& options, const ReadLimits& limits) {
    return guarded(a, [&] {
        const LoadedFile first = load_file(a, limits, kEveryKind);
        const LoadedFile second = load_file(b, limits, kEveryKind);
        check_options(options, first.payload, second.payload);
        std::vector<Difference> differences = Comparison(options).run(first.payload, second.payload);
        if (first.header.kind != second.header.kind)
            differences.insert(differences.begin(), Difference{"/@kind",
                                                               std::string(to_string(first.header.kind)) +
                                                                   " and " + to_string(second.header.kind),
                                                               0, 0});
        return differences;
    });
}

}  // namespace knead
