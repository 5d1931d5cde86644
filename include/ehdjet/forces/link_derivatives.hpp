#pragma once

#include "ehdjet/core/columns.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

namespace ehdjet {

using Mat3 = Eigen::Matrix3d;

/// What local terms answer to a change of one link, with d_k = r_k - r_u, w_k = v_k - v_u the
/// differences to the upstream neighbour u of bead k, and to a change of a bead's velocity:
///
///     delta F_u     += pull_upper_k delta d_k + tension_k delta sigma_k + damping_k delta w_k
///     delta F_k     -= pull_lower_k delta d_k + tension_k delta sigma_k + damping_k delta w_k
///     delta F_k     -= drag_k delta v_k
///     delta sigma_k' = stretching_k . delta w_k + turning_k . delta d_k - relaxation delta sigma_k
///
/// shapes : (beads); entries of beads that have no link are zero; damping and drag are empty as
///          long as no term has any
/// units  : [N/m], [N s/m], [N/Pa], [Pa/m], [Pa/(m s)], [1/s]
struct LinkDerivatives {
  std::vector<Mat3> pull_upper, pull_lower, damping, drag;
  std::vector<Vec3> tension, stretching, turning;
  std::vector<double> relaxation; ///< 1/tau
  /// sigma among the integrated columns; none: nothing answers with a sigma.
  std::optional<std::size_t> sigma;

  void reset(std::size_t beads) {
    const auto clear = [beads](auto& column, const auto& zero) {
      column.resize(beads); // unlike assign it makes room for more to come
      std::fill(column.begin(), column.end(), zero);
    };
    for (auto* column : {&pull_upper, &pull_lower}) clear(*column, Mat3(Mat3::Zero()));
    for (auto* column : {&tension, &stretching, &turning})
      clear(*column, Vec3(Vec3::Zero()));
    clear(relaxation, 0.0);
    sigma.reset();
    damping.clear(), drag.clear();
  }
  /// A tension pulls both ends of its link alike.
  void add_pull(std::size_t k, const Mat3& pull) {
    pull_upper[k] += pull, pull_lower[k] += pull;
  }
  void add_damping(std::size_t k, const Mat3& response) { add(damping, k, response); }
  void add_drag(std::size_t k, const Mat3& response) { add(drag, k, response); }

private:
  void add(std::vector<Mat3>& column, std::size_t k, const Mat3& response) const {
    if (column.empty()) column.assign(relaxation.size(), Mat3::Zero());
    column[k] += response;
  }
};

} // namespace ehdjet
