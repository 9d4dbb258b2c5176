// SPDX-License-Identifier: Apache-2.0
// Presses the levels of an object with the real runtime and compares their forces and times.
//   steak_press FOLDER SCENE LEVEL... [the first level is the reference]
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "knead/runtime/simulation.h"

namespace {

constexpr double kDepthM = 2.5e-3;  // 10 % of the steak's thickness
constexpr double kRampS = 1.0;
constexpr double kHoldS = 0.5;  // after it the force has settled
constexpr double kStepS = 1e-3;
constexpr double kJnd = 0.10;  // just noticeable difference of a force [HHC*08 in the paper]

struct Press {
    std::string level;
    std::filesystem::path file;
    std::size_t tetrahedra = 0;
    std::vector<double> force_n;  ///< up, on the tool, after each step
    std::vector<double> step_us;
    std::uint32_t status = 0;  ///< all bits that any step set
};

double depth_at(double time_s) {
    return kDepthM * std::min(1.0, time_s / kRampS);
}

void show_progress(const std::string& level, std::size_t step, std::size_t steps) {
    if (isatty(STDERR_FILENO) == 0 || step % 50 != 0) return;
    const auto filled = static_cast<int>(24 * step / steps);
    std::fprintf(stderr, "\r\033[K[%.*s%.*s] pressing %s", filled, "########################", 24 - filled,
                 "........................", level.c_str());
    if (step == 0) std::fprintf(stderr, "\r\033[K");
}

knead::Result<Press> press(const std::string& level, const std::filesystem::path& file) {
    auto loaded = knead::Simulation::load(file);
    if (!loaded.ok()) return loaded.error();
    knead::Simulation& simulation = loaded.value();
    Press result{level, file, simulation.tetrahedron_count(), {}, {}, 0};
    const knead::Pose rest = simulation.tool_rest_pose();
    const auto steps = static_cast<std::size_t>(std::lround((kRampS + kHoldS) / kStepS));
    for (std::size_t i = 1; i <= steps; ++i) {
        knead::Pose pose = rest;
        pose.position_m[2] -= depth_at(static_cast<double>(i) * kStepS);
        const auto start = std::chrono::steady_clock::now();
        const knead::StepResult step = simulation.step(pose, kStepS);
        const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
        result.force_n.push_back(step.force_n[2]);
        result.step_us.push_back(took.count());
        result.status |= step.status;
        show_progress(level, i == steps ? 0 : i, steps);
    }
    return result;
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                     values.end());
    return values[values.size() / 2];
}

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(values.size());
}

void print_row(const Press& press, const Press& reference) {
    const double force = press.force_n.back();
    const double error = force / reference.force_n.back() - 1;
    std::string verdict = "reference";
    if (&press != &reference) verdict = std::abs(error) <= kJnd ? "inside" : "outside";
    if (press.status != knead::kStepOk) verdict += " (status " + std::to_string(press.status) + ")";
    std::printf("%-12s %10zu %9.3f N %+8.1f %%   %-10s %9.0f %10.0f Hz %9ju\n", press.level.c_str(),
                press.tetrahedra, force, 100 * error, verdict.c_str(), median(press.step_us),
                1e6 / mean(press.step_us),
                static_cast<std::uintmax_t>(std::filesystem::file_size(press.file)));
}

void write_curves(const std::filesystem::path& file, const std::vector<Press>& presses) {
    std::ofstream csv(file);
    csv << "time_s,depth_m";
    for (const Press& press : presses)
        csv << ',' << press.level << "_n";
    csv << '\n';
    for (std::size_t i = 0; i < presses.front().force_n.size(); ++i) {
        const double time_s = static_cast<double>(i + 1) * kStepS;
        csv << time_s << ',' << depth_at(time_s);
        for (const Press& press : presses)
            csv << ',' << press.force_n[i];
        csv << '\n';
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fprintf(stderr,
                     "usage: steak_press FOLDER SCENE LEVEL...   (the first level is the reference)\n");
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    const std::string scene = argv[2];
    std::vector<Press> presses;
    for (int i = 3; i < argc; ++i) {
        auto result = press(argv[i], folder / (scene + "." + argv[i] + ".hdf"));
        if (!result.ok()) {
            std::fprintf(stderr, "steak_press: error: %s\n", result.error().text().c_str());
            return 3;
        }
        presses.push_back(std::move(result).value());
    }

    std::printf("%s pressed %.1f mm over %.0f s and held %.1f s, steps of %.0f ms, on one core\n\n",
                scene.c_str(), kDepthM * 1e3, kRampS, kHoldS, kStepS * 1e3);
    std::printf("%-12s %10s %11s %10s   %-10s %9s %13s %9s\n", "level", "tetrahedra", "force", "error",
                "10 % JND", "us/step", "rate", "bytes");
    for (const Press& press : presses)
        print_row(press, presses.front());
    write_curves(folder / (scene + ".press.csv"), presses);
    std::printf(
        "\nThe error is against the fine mesh with its raw elasticities (%s). us/step is the median.\n",
        presses.front().level.c_str());
    return 0;
}
