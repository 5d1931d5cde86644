#pragma once

#include "ehdjet/core/columns.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace ehdjet {

using Mat3 = Eigen::Matrix3d;

/// What local terms answer to a change of one link, with d_k = r_k - r_u, w_k = v_k - v_u the
/// differences to the upstream neighbour u of bead k:
///
///     delta F_u     += pull_upper_k delta d_k + tension_k delta sigma_k
///     delta F_k     -= pull_lower_k delta d_k + tension_k delta sigma_k
///     delta sigma_k' = stretching_k . delta w_k + turning_k . delta d_k - relaxation delta sigma_k
///
/// shapes : (beads); entries of beads that have no link are zero
/// units  : [N/m], [N/Pa], [Pa/m], [Pa/(m s)], [1/s]
struct LinkDerivatives {
  std::vector<Mat3> pull_upper, pull_lower;
  std::vector<Vec3> tension, stretching, turning;
  std::vector<double> relaxation; ///< 1/tau

  void reset(std::size_t beads) {
    const auto clear = [beads](auto& column, const auto& zero) {
      column.resize(beads); // unlike assign it makes room for more to come
      std::fill(column.begin(), column.end(), zero);
    };
    for (auto* column : {&pull_upper, &pull_lower}) clear(*column, Mat3(Mat3::Zero()));
    for (auto* column : {&tension, &stretching, &turning})
      clear(*column, Vec3(Vec3::Zero()));
    clear(relaxation, 0.0);
  }
  /// A tension pulls both ends of its link alike.
  void add_pull(std::size_t k, const Mat3& pull) {
    pull_upper[k] += pull, pull_lower[k] += pull;
  }
};

} // namespace ehdjet
