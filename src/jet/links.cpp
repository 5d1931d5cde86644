#include "ehdjet/jet/links.hpp"

#include "ehdjet/core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace ehdjet {

void Links::compute(ConstVec3View r, std::size_t first_bead, BeadRange targets) {
  const std::size_t n = r.size();
  const BeadRange part = targets.within(n);
  head = first_bead;
  first = std::max(head, part.begin), last = std::min(n - 1, std::max(part.end, head));
  beads = {first, std::max(first, part.end)};
  if (length.size() != n + 1)
    for (auto* column : {&dx, &dy, &dz, &length}) column->resize(n + 1);
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}, n})
    dx[k] = dy[k] = dz[k] = 0, length[k] = 1;

  const auto link = [r, x = dx.data(), y = dy.data(), z = dz.data(),
                     l = length.data()](std::size_t k, std::size_t upstream) {
    x[k] = r.x[k] - r.x[upstream];
    y[k] = r.y[k] - r.y[upstream];
    z[k] = r.z[k] - r.z[upstream];
    l[k] = std::sqrt(x[k] * x[k] + y[k] * y[k] + z[k] * z[k]);
  };
  std::size_t begin = first;
  if (begin == head && begin < n) link(begin++, 0);
  for_parts(begin, last + 1, [&link](std::size_t from, std::size_t to) {
#pragma omp simd
    for (std::size_t k = from; k < to; ++k) link(k, k - 1);
  });
}

} // namespace ehdjet
