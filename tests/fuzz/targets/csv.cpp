// SPDX-License-Identifier: Apache-2.0
// Tables of knead-material: elasticities per element and per region.
#include "material/csv.h"
#include "fuzz/text_target.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    fuzz::read_or_refuse([&] {
        const tools::ValueTable table = tools::parse_value_csv(text);
        fuzz::expect(!table.youngs_modulus_pa.empty(), "a table has rows");
        fuzz::expect(table.poissons_ratio.size() == table.density_kg_per_m3.size(), "columns are as long");
    });
    fuzz::read_or_refuse([&] { fuzz::expect(!tools::parse_region_csv(text).empty(), "a table has rows"); });
}
