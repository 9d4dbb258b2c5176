// SPDX-License-Identifier: Apache-2.0
// What knead-evaluate reads back from its cache: not an answer of its own, then the answer is no, never an
// error.
#include "evaluate/cell_json.h"
#include "evaluate/static_answer.h"
#include "fuzz/target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    const std::string text(fuzz::text_of(data, size));
    tools::CellResult cell;
    (void)tools::from_cache(text, cell);
    (void)tools::times_from_cache(text, cell);
    tools::SpeedPair pair;
    (void)tools::speed_from_cache(text, pair);
    tools::ForceCurve curve;
    if (tools::curve_from_cache(text, curve))
        fuzz::expect(curve.time_s.size() == curve.force_n.size(), "a force for each time");
    const auto answer = tools::answer_of(text);
    fuzz::expect(!answer || answer->displacement_m.size() * sizeof(Point) <= size, "an answer fits its file");
}
