// SPDX-License-Identifier: GPL-3.0-or-later
#include "overlap/exact.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/version.h>

#include "overlap/clip.h"
#include "overlap/plane_values.h"

namespace knead::tools {

double exact_share(const Corners& a, const Corners& b) {
    using Number = CGAL::Exact_rational;
    return CGAL::to_double(share_inside(plane_values(a, faces_of<Number>(b)), 0, 4));
}

double exact_volume(const Corners& corners) {
    using Number = CGAL::Exact_rational;
    return CGAL::to_double(Number(plane_values(corners, faces_of<Number>(corners))[3][3] / 6));
}

std::string exact_library_version() {
    return "CGAL " CGAL_VERSION_STR;
}

}  // namespace knead::tools
