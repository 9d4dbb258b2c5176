// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <random>

namespace knead::test {

/// Numbers that are the same on every platform.
class Random {
  public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    /// In [low, high).
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
    }
    /// Entries within +- size.
    Eigen::Matrix3d matrix(double size) {
        Eigen::Matrix3d m;
        for (int i = 0; i < 9; ++i)
            m(i) = uniform(-size, size);
        return m;
    }
    Eigen::Quaterniond rotation() {
        return Eigen::Quaterniond(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1))
            .normalized();
    }

  private:
    std::mt19937_64 engine_;
};

}  // namespace knead::test
