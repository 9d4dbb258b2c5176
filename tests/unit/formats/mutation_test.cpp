// SPDX-License-Identifier: Apache-2.0
// Cut and flipped files: the reader gives an error or the very same data, and never crashes.
#include <gtest/gtest.h>

#include <random>

#include "knead/formats/inspect.h"
#include "same.h"
#include "samples.h"
#include "session_sample.h"

namespace knead::test {
namespace {

constexpr std::size_t kPrefixStep =
    31;  ///< every byte would take minutes; primes meet all positions in 8-byte fields
constexpr std::size_t kFlipStep = 7;
constexpr int kRandomMutations = 150;

template <class T>
using Reader = Result<T> (*)(const std::filesystem::path&, const ReadLimits&);

template <class T>
void expect_error_or_same(const std::filesystem::path& file, const T& object, Reader<T> read,
                          const std::string& what) {
    const Result<T> result = read(file, ReadLimits{});
    if (!result.ok()) return;
    EXPECT_TRUE(same(result.value(), object)) << what << ": other data were read without an error";
}

template <class T>
void check_prefixes(const std::vector<char>& bytes, Reader<T> read) {
    const Folder folder;
    for (std::size_t size = 0; size < bytes.size(); size += kPrefixStep) {
        put_bytes(folder / "cut.hdf", {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)});
        EXPECT_FALSE(read(folder / "cut.hdf", ReadLimits{}).ok()) << "the first " << size << " bytes";
    }
}

template <class T>
void check_flips(std::vector<char> bytes, const T& object, Reader<T> read) {
    const Folder folder;
    for (std::size_t at = 0; at < bytes.size(); at += kFlipStep) {
        const char mask = static_cast<char>(1U << (at / kFlipStep) % 8);
        bytes[at] = static_cast<char>(bytes[at] ^ mask);
        put_bytes(folder / "flip.hdf", bytes);
        expect_error_or_same(folder / "flip.hdf", object, read, "byte " + std::to_string(at));
        bytes[at] = static_cast<char>(bytes[at] ^ mask);
    }
}

/// Several bytes at once, set to what tends to hurt.
template <class T>
void check_random(const std::vector<char>& bytes, const T& object, Reader<T> read) {
    const Folder folder;
    std::mt19937_64 random(20'261'122);
    const char values[] = {'\0', '\x7f', '\xff', '\x80', '\x01'};
    for (int i = 0; i < kRandomMutations; ++i) {
        std::vector<char> mutant = bytes;
        for (int k = 0; k < 1 + i % 8; ++k)
            mutant[random() % mutant.size()] = values[random() % sizeof values];
        put_bytes(folder / "mutant.hdf", mutant);
        expect_error_or_same(folder / "mutant.hdf", object, read, "mutant " + std::to_string(i));
    }
}

template <class T, class Write>
void check_all(const T& object, Write write, Reader<T> read) {
    const Folder folder;
    ASSERT_TRUE(write(folder / "valid.hdf", object, sample_provenance()).ok());
    const std::vector<char> bytes = bytes_of(folder / "valid.hdf");
    check_prefixes(bytes, read);
    check_flips(bytes, object, read);
    check_random(bytes, object, read);
}

TEST(Damaged_asset, Gives_an_error_or_the_same_data) {
    check_all<Asset>(sample_asset(), write_asset, read_asset);
}

TEST(Damaged_clustering, Gives_an_error_or_the_same_data) {
    check_all<ClusteredObject>(sample_clustering(), write_clustering, read_clustering);
}

TEST(Damaged_overlap, Gives_an_error_or_the_same_data) {
    check_all<OverlapMatrix>(sample_overlap(), write_overlap, read_overlap);
}

TEST(Damaged_session, Gives_an_error_or_the_same_data) {
    check_all<SessionLog>(sample_session(), write_session_log, read_session_log);
}

TEST(Damaged_large_asset, Gives_an_error_or_the_same_data_in_its_chunks) {
    const Asset asset = sample_asset(4);  // large enough for compressed chunks
    const Folder folder;
    ASSERT_TRUE(write_asset(folder / "valid.hdf", asset, {}).ok());
    check_random<Asset>(bytes_of(folder / "valid.hdf"), asset, read_asset);
}

}  // namespace
}  // namespace knead::test
