// SPDX-License-Identifier: Apache-2.0
// Runs a fuzz target over kept files, without libFuzzer: any compiler will do.
//   fuzz_<target> [--mutants N] FILE|FOLDER...
// Every file is one input; then N mutants of them, the same ones each time. An input that crashes ends the
// program, which names it; so does one that takes more than a second (entry.cpp). In 512 MB of memory, unless
// AddressSanitizer or ThreadSanitizer take their own.
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

#include "fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define KNEAD_SANITIZED 1
#else
#define KNEAD_SANITIZED 0
#endif

namespace knead::fuzz {
namespace {

namespace fs = std::filesystem;

using Input = std::vector<std::uint8_t>;

constexpr rlim_t kMostMemory = rlim_t{512} << 20;
/// What numbers in files tend to be replaced with.
constexpr const char* kWords[] = {
    "0",  "-1",   "1e308", "nan",    "-9223372036854775808", "9223372036854775807",
    "[[", "\"\"", "\n",    "1e-320", "4294967296",           "\xff\xff\xff\xff"};

std::string print_name;  ///< of the input in hand

void run(const std::string& name, const Input& input) {
    print_name = name;
    // A copy without slack, so that AddressSanitizer sees the first byte behind it.
    const std::vector<std::uint8_t> exact(input.begin(), input.end());
    (void)LLVMFuzzerTestOneInput(exact.data(), exact.size());
}

std::vector<fs::path> files_of(const fs::path& path) {
    std::vector<fs::path> files;
    if (fs::is_regular_file(path)) files.push_back(path);
    if (fs::is_directory(path))
        for (const auto& entry : fs::recursive_directory_iterator(path))
            if (entry.is_regular_file()) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

Input content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class Mutator {
  public:
    explicit Mutator(const std::vector<Input>& seeds) : seeds_(seeds) {}

    Input next() {
        Input input = seeds_[below(seeds_.size())];
        for (std::size_t changes = 1 + below(6); changes > 0; --changes)
            change(input);
        return input;
    }

  private:
    std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }

    void change(Input& input) {
        if (input.empty()) return;
        const std::size_t at = below(input.size());
        const auto place = input.begin() + static_cast<std::ptrdiff_t>(at);
        const std::size_t length = std::min(1 + below(16), input.size() - at);
        switch (below(6)) {
            case 0:
                *place = static_cast<std::uint8_t>(*place ^ 1U << below(8));
                break;
            case 1:
                *place = static_cast<std::uint8_t>(random_());
                break;
            case 2:
                input.erase(place, place + static_cast<std::ptrdiff_t>(length));
                break;
            case 3: {
                const char* word = kWords[below(std::size(kWords))];
                input.erase(place, place + static_cast<std::ptrdiff_t>(length));
                input.insert(input.begin() + static_cast<std::ptrdiff_t>(at), word, word + std::strlen(word));
                break;
            }
            case 4: {
                const Input& other = seeds_[below(seeds_.size())];
                const std::size_t from = below(other.size());
                const std::size_t count = std::min(below(64), other.size() - from);
                input.insert(place, other.begin() + static_cast<std::ptrdiff_t>(from),
                             other.begin() + static_cast<std::ptrdiff_t>(from + count));
                break;
            }
            default:
                input.resize(at);
        }
    }

    const std::vector<Input>& seeds_;
    std::mt19937_64 random_{20'261'122};
};

int replay(int argc, char** argv) {
    std::size_t mutants = 0;
    std::vector<Input> inputs;
    for (int i = 1; i < argc; ++i) {
        if (std::strcmp(argv[i], "--mutants") == 0 && i + 1 < argc) {
            mutants = std::stoul(argv[++i]);
            continue;
        }
        for (const fs::path& file : files_of(argv[i])) {
            inputs.push_back(content_of(file));
            run(file.string(), inputs.back());
        }
    }
    if (inputs.empty()) {
        std::fprintf(stderr, "no inputs\n");
        return 2;
    }
    Mutator mutator(inputs);
    for (std::size_t i = 0; i < mutants; ++i)
        run("mutant " + std::to_string(i), mutator.next());
    std::printf("%zu files and %zu mutants\n", inputs.size(), mutants);
    return 0;
}

void name_the_input(int) {
    (void)!::write(STDERR_FILENO, print_name.data(), print_name.size());  // all that a signal handler may
    (void)!::write(STDERR_FILENO, "\n", 1);
    std::_Exit(1);
}

}  // namespace
}  // namespace knead::fuzz

int main(int argc, char** argv) {
    if (!KNEAD_SANITIZED) {
        const rlimit limit{knead::fuzz::kMostMemory, knead::fuzz::kMostMemory};
        (void)setrlimit(RLIMIT_DATA, &limit);
    }
    std::signal(SIGABRT, knead::fuzz::name_the_input);
    if (!KNEAD_SANITIZED) std::signal(SIGSEGV, knead::fuzz::name_the_input);
    return knead::fuzz::replay(argc, argv);
}
