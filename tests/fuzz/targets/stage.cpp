// SPDX-License-Identifier: Apache-2.0
// Files between the stages, of every kind, as the tools and knead-asset open them.
#include "fuzz/knead_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    const std::string& file = fuzz::mutant_file(data, size);
    const Result<FileHeader> header = read_header(file, fuzz::small_limits());
    fuzz::expect_good_manners(header);
    if (!header.ok()) return;
    const Result<FileInfo> info = inspect_file(file, fuzz::small_limits());
    const Result<FileKind> kind = validate_file(file, fuzz::small_limits());
    fuzz::expect_good_manners(info);
    fuzz::expect_good_manners(kind);
    fuzz::expect(!kind.ok() || info.ok(), "what is valid can be inspected");
}
