// SPDX-License-Identifier: Apache-2.0
// What tells files apart in front of gmsh. gmsh runs what it does not know as a script, so that nothing but
// whole sections may get past for an MSH in text.
#include "fuzz/text_target.h"
#include "mesh/recognise.h"

void knead::fuzz::read_hostile_file(const std::uint8_t* data, std::size_t size) {
    const std::string_view content = fuzz::text_of(data, size);
    fuzz::read_or_refuse([&] {
        const tools::FileFormat format = tools::recognise(content);
        fuzz::expect(tools::description(format)[0] != '\0', "a format has a name");
        if (format == tools::FileFormat::msh)
            fuzz::expect(content.front() == '$', "an MSH begins with a section");
        if (format == tools::FileFormat::step)
            fuzz::expect(content.substr(0, 13) == "ISO-10303-21;", "a STEP begins as a STEP");
        for (const char* extension : {".msh", ".STEP", ".stl", ".veg", ".mesh", ".geo", ""})
            fuzz::read_or_refuse([&] { tools::require_matching_extension(format, extension); });
    });
}
