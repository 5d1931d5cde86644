#pragma once

#include "ehdjet/core/columns.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace ehdjet {

using Mat3 = Eigen::Matrix3d;

/// What local terms answer to a change of one link, with d_k = r_k - r_u, w_k = v_k - v_u the
/// differences to the upstream neighbour u of bead k, and to a change of a bead's velocity. With a sum
/// over the columns sigma of links that the terms have added,
///
///     delta F_u     += pull_upper_k delta d_k + sum tension_k delta sigma_k + damping_k delta w_k
///     delta F_k     -= pull_lower_k delta d_k + sum tension_k delta sigma_k + damping_k delta w_k
///     delta F_k     -= drag_k delta v_k
///     delta sigma_k' = stretching_k . delta w_k + turning_k . delta d_k - relaxation_k delta sigma_k
///                      - coupling_k delta sigma*_k
///
/// where sigma* is the partner of a column of a pair.
/// shapes : (beads); entries of beads that have no link are zero; damping and drag are empty as
///          long as no term has any, coupling in columns without a partner
/// units  : [N/m], [N s/m]; with sigma in Pa [N/Pa], [Pa/m], [Pa/(m s)], [1/s]
struct LinkDerivatives {
  /// One of the integrated columns of links.
  struct Column {
    std::size_t place = 0; ///< among the integrated columns
    std::vector<Vec3> tension, stretching, turning;
    std::vector<double> relaxation; ///< 1/tau
    std::vector<double> coupling;   ///< [1/s]
  };
  std::vector<Mat3> pull_upper, pull_lower, damping, drag;

  void reset(std::size_t beads) {
    for (auto* column : {&pull_upper, &pull_lower})
      clear(*column, beads, Mat3(Mat3::Zero()));
    damping.clear(), drag.clear();
    used_ = 0;
  }
  [[nodiscard]] std::span<Column> columns() { return std::span(columns_).first(used_); }
  [[nodiscard]] std::span<const Column> columns() const {
    return std::span(columns_).first(used_);
  }
  /// All zero. Valid until the next column is added.
  Column& add_column(std::size_t place) {
    if (used_ == columns_.size())
      columns_.emplace_back(); // kept for the next linearization
    Column& column = columns_[used_++];
    const std::size_t beads = pull_upper.size();
    column.place = place;
    for (auto* values : {&column.tension, &column.stretching, &column.turning})
      clear(*values, beads, Vec3(Vec3::Zero()));
    clear(column.relaxation, beads, 0.0);
    column.coupling.clear();
    return column;
  }
  /// Two columns, the second behind the first. `coupled`: each has an effect on the rate of the other.
  std::span<Column, 2> add_pair(std::size_t first, std::size_t second, bool coupled) {
    add_column(first), add_column(second);
    const std::span<Column, 2> pair(columns_.data() + used_ - 2, 2);
    if (coupled)
      for (Column& column : pair) clear(column.coupling, pull_upper.size(), 0.0);
    return pair;
  }
  /// A tension pulls both ends of its link alike.
  void add_pull(std::size_t k, const Mat3& pull) {
    pull_upper[k] += pull, pull_lower[k] += pull;
  }
  void add_damping(std::size_t k, const Mat3& response) { add(damping, k, response); }
  void add_drag(std::size_t k, const Mat3& response) { add(drag, k, response); }

private:
  template <class T>
  static void clear(std::vector<T>& column, std::size_t beads, const T& zero) {
    column.resize(beads); // unlike assign it makes room for more to come
    std::fill(column.begin(), column.end(), zero);
  }
  void add(std::vector<Mat3>& column, std::size_t k, const Mat3& response) const {
    if (column.empty()) column.assign(pull_upper.size(), Mat3::Zero());
    column[k] += response;
  }

  std::vector<Column> columns_;
  std::size_t used_ = 0;
};

} // namespace ehdjet
