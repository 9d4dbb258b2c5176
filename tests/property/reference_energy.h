// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "knead/formats/asset.h"
#include "knead/formats/asset_object.h"
#include "knead/formats/material.h"
#include "reference/elastic_body.h"

namespace knead::test {

/// The elements of an asset as the reference solver has them, which shares no code with the runtime.
inline tools::ElasticBody reference_body(const Asset& asset) {
    const MaterialObject object = object_of(asset);
    return {object.mesh, object.material};
}

/// @param positions_m [3 nodes]
inline double elastic_energy_j(const Asset& asset, const Eigen::VectorXd& positions_m) {
    return reference_body(asset).energy_j(positions_m);
}

}  // namespace knead::test
