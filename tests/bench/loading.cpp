// SPDX-License-Identifier: Apache-2.0
#include "bench/loading.h"

#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "baseline/statistics.h"
#include "bench/allocation.h"
#include "knead/formats/write/write.h"

namespace knead::bench {
namespace {

/// A file of this process that goes away with the scope.
class TemporaryFile {
  public:
    TemporaryFile()
        : path_(std::filesystem::temp_directory_path() /
                ("knead-bench-" + std::to_string(::getpid()) + ".asset.hdf")) {}
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace

Loading measure_loading(const Asset& asset, int repetitions, const SimulationConfig& config) {
    const TemporaryFile file;
    Provenance provenance;
    provenance.tool = "knead-bench";
    provenance.tool_version = "1";
    if (const Status written = write_asset(file.path(), asset, provenance); !written)
        throw std::runtime_error(written.error().text());
    Loading loading;
    loading.file_bytes = std::filesystem::file_size(file.path());
    std::vector<double> times_ms;
    for (int k = 0; k <= repetitions; ++k) {
        const std::int64_t before = allocation_count().live_bytes;
        const auto start = std::chrono::steady_clock::now();
        const Result<Simulation> loaded = Simulation::load(file.path(), config);
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
        if (!loaded) throw std::runtime_error(loaded.error().text());
        times_ms.push_back(took.count());
        loading.simulation_bytes = allocation_count().live_bytes - before;
    }
    loading.first_ms = times_ms.front();
    times_ms.erase(times_ms.begin());
    loading.median_ms = baseline::percentiles(times_ms).p50;
    return loading;
}

Simulation make_simulation(const Asset& asset, const SimulationConfig& config) {
    Result<Simulation> made = Simulation::create(asset, config);
    if (!made) throw std::runtime_error(made.error().text());
    return std::move(made).value();
}

}  // namespace knead::bench
