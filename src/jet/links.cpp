#include "ehdjet/jet/links.hpp"

#include <algorithm>
#include <cmath>

namespace ehdjet {

void Links::compute(ConstVec3View r, std::size_t first_bead) {
  const std::size_t beads = r.size();
  first = first_bead, last = beads - 1;
  if (length.size() != beads + 1)
    for (auto* column : {&dx, &dy, &dz, &length}) column->resize(beads + 1);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}, beads})
    dx[k] = dy[k] = dz[k] = 0, length[k] = 1;

  const auto link = [&](std::size_t k, std::size_t upstream) {
    dx[k] = r.x[k] - r.x[upstream];
    dy[k] = r.y[k] - r.y[upstream];
    dz[k] = r.z[k] - r.z[upstream];
    length[k] = std::sqrt(dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k]);
  };
  link(first, 0);
#pragma omp simd
  for (std::size_t k = first + 1; k < beads; ++k) link(k, k - 1);
}

} // namespace ehdjet
