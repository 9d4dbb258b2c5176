// SPDX-License-Identifier: Apache-2.0
#include "sha256.h"

#include <gtest/gtest.h>

namespace knead {
namespace {

std::string digest(const std::string& text) {
    Sha256 hash;
    hash.update(text.data(), text.size());
    return hash.hex_digest();
}

// The examples of FIPS 180-4 and the NIST test vectors.
TEST(Sha256, Of_the_standard_examples_gives_the_published_digests) {
    EXPECT_EQ(digest(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(digest("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(digest("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(digest(std::string(1'000'000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, Of_a_stream_in_pieces_equals_that_of_the_whole) {
    const std::string text(1000, 'x');
    for (std::size_t piece : {1, 7, 55, 56, 63, 64, 65, 119, 128}) {
        Sha256 hash;
        for (std::size_t at = 0; at < text.size(); at += piece)
            hash.update(text.data() + at, std::min(piece, text.size() - at));
        EXPECT_EQ(hash.hex_digest(), digest(text)) << piece;
    }
}

}  // namespace
}  // namespace knead
