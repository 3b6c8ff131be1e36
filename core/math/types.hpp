// SPDX-License-Identifier: BSD-3-Clause
// The linear-algebra names used everywhere in core.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace unfurl {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using ConstVec = Eigen::Ref<const VectorXd>;
using MutVec = Eigen::Ref<VectorXd>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

inline constexpr double pi = 3.14159265358979323846;
inline constexpr double radians_per_degree = pi / 180.0;

}  // namespace unfurl
