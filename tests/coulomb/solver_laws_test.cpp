#include <limits>

#include "coulomb/all_solvers.hpp"
#include "coulomb/reference.hpp"

namespace ehdjet::test {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double k_C = constants::coulomb;

class SolverLaws : public SolverTest {};

// The number is the force in newton between 1 nC and 2 nC at 0.2 mm, computed in 30 digits.
TEST_P(SolverLaws, two_beads_repel_with_coulombs_force) {
  Chain pair(2);
  pair.q = {1e-9, 2e-9};
  pair.set(1, 2e-4 * along);
  const Force force = force_on(pair, *solver);
  constexpr double exact = 0.449377589368409;
  EXPECT_LE((force[1] - exact * along).norm(), 1e-14 * exact);
  EXPECT_LE((force[0] + exact * along).norm(), 1e-14 * exact);
}

TEST_P(SolverLaws, opposite_charges_attract) {
  Chain pair(2);
  pair.q = {1, -1};
  pair.set(1, along);
  EXPECT_LE((force_on(pair, *solver)[1] + k_C * along).norm(), 1e-14 * k_C);
}

// The kernels correct an estimate of 1/r whose error depends on the leading digits of r^2:
// those of 4000 distances over two binades. A sum over many pairs would average them out.
TEST_P(SolverLaws, a_pair_is_exact_to_round_off_whatever_its_distance) {
  Chain pair(2);
  for (int k = 0; k < 4000; ++k) {
    const double d = std::exp2(k / 2000.0);
    pair.x[1] = d;
    const long double exact =
        static_cast<long double>(k_C) / (static_cast<long double>(d) * d);
    const double error = static_cast<double>(force_on(pair, *solver).x[1] / exact - 1);
    const double allowed = std::max(8 * eps, solver->accuracy().tolerance); // 8: operations
    ASSERT_LE(std::abs(error), allowed) << d;
  }
}

// F = q^2/(4 R^2) sum_{k=1}^{n-1} 1/sin(pi k/n), purely radial and the same for all.
TEST_P(SolverLaws, a_ring_pushes_each_bead_outwards_by_the_cosecant_sum) {
  struct Row {
    std::size_t n;
    double cosecant_sum;
  };
  for (const Row row : {Row{3, 2.309401076758503}, Row{10, 15.449799591883853},
                        Row{100, 301.17140951220359511}, Row{1000, 4477.5939321602205281},
                        Row{10000, 59434.652163128639362}}) {
    const double step = 2 * M_PI / static_cast<double>(row.n), radius = 0.7;
    const Chain ring = helix(row.n, radius, step, 0);
    const Force force = force_on(ring, *solver);
    const double exact = k_C / (4 * radius * radius) * row.cosecant_sum;
    const double pair_sum = static_cast<double>(ReferenceForce(ring, 0).pair_sum);
    // A position is rounded by a few eps R, which moves a neighbour at `step` R by this much.
    const double allowed = (tolerance() + 8 * eps / step) * pair_sum;
    double squares = 0;
    for (std::size_t i = 0; i < row.n; ++i) {
      const double angle = static_cast<double>(i) * step;
      const Vec3 outwards = std::cos(angle) * across + std::sin(angle) * upward;
      ASSERT_LE((force[i] - exact * outwards).norm(), allowed) << row.n << ' ' << i;
      squares += std::pow(force[i].dot(outwards) - exact, 2);
    }
    EXPECT_LE(std::sqrt(squares / static_cast<double>(row.n)), allowed)
        << "spread, " << row.n;
  }
}

// F_i = (q/l)^2 [H2(i) - H2(n-1-i)] with H2(m) = sum_{k<=m} 1/k^2; the ends from a table.
TEST_P(SolverLaws, a_straight_chain_is_pushed_apart_by_harmonic_sums) {
  struct Row {
    std::size_t n;
    double end, second;
  };
  for (const Row row : {Row{3, 1.25, 0}, Row{11, 1.54976773116654069, 0.53976773116654069},
                        Row{101, 1.63498390018489287, 0.634883900184892865},
                        Row{1001, 1.6439345666815598, 0.643933566681559803}}) {
    constexpr double l = 0.3;
    const Chain line = straight_chain(row.n, l);
    const Force force = force_on(line, *solver);
    const double unit = k_C / (l * l);
    // The ends of the chain are at n l, rounded to n eps of the spacing; 4 > pi^2/3.
    const double allowed = (tolerance() + 2 * static_cast<double>(row.n) * eps) * 4 * unit;
    EXPECT_LE((force[row.n - 1] - row.end * unit * along).norm(), allowed);
    EXPECT_LE((force[0] + row.end * unit * along).norm(), allowed);
    EXPECT_LE((force[row.n - 2] - row.second * unit * along).norm(), allowed);

    std::vector<double> h2(row.n, 0.0);
    for (std::size_t k = 1; k < row.n; ++k)
      h2[k] = h2[k - 1] + 1 / static_cast<double>(k * k);
    for (std::size_t i = 0; i < row.n; ++i) {
      const Vec3 exact = (h2[i] - h2[row.n - 1 - i]) * unit * along;
      ASSERT_LE((force[i] - exact).norm(), allowed) << row.n << ' ' << i;
    }
  }
}

// Screw symmetry: in the frame of bead i, bead i+m is where bead m is in the frame of bead 0.
// With d_m = (R - R cos(m a), -R sin(m a), -m h) in (radial, tangential, axial) direction and
// P(M) = sum_{m=1}^M d_m/|d_m|^3, the beads ahead give P(n-1-i), those behind P(i) with the
// last two components reversed.
TEST_P(SolverLaws, a_helix_feels_the_lattice_sum_of_its_screw) {
  constexpr std::size_t n = 3001;
  constexpr double radius = 1.3, angle = 0.11, rise = 0.017;
  const Chain chain = helix(n, radius, angle, rise);
  const Force force = force_on(chain, *solver);

  using Local = Eigen::Matrix<long double, 3, 1>;
  std::vector<Local> ahead(n, Local::Zero());
  long double pair_sum = 0; // of a bead in the middle of an endless helix
  for (std::size_t m = 1; m < n; ++m) {
    const long double a = static_cast<long double>(m) * angle;
    const Local d{radius - radius * std::cos(a), -radius * std::sin(a),
                  -static_cast<long double>(m) * rise};
    ahead[m] = ahead[m - 1] + d / (d.squaredNorm() * d.norm());
    pair_sum += 2 / d.squaredNorm();
  }
  const double size = n * rise, spacing = std::hypot(radius * angle, rise);
  const double allowed =
      k_C * (tolerance() + 4 * eps * size / spacing) * static_cast<double>(pair_sum);
  for (std::size_t i = 0; i < n; ++i) {
    const Local &p = ahead[n - 1 - i], &b = ahead[i];
    const Vec3 local = Local(p[0] + b[0], p[1] - b[1], p[2] - b[2]).cast<double>();
    const double a = static_cast<double>(i) * angle;
    const Vec3 radial = std::cos(a) * across + std::sin(a) * upward;
    const Vec3 exact =
        k_C * (local[0] * radial + local[1] * along.cross(radial) + local[2] * along);
    ASSERT_LE((force[i] - exact).norm(), allowed) << i;
  }
}

TEST_P(SolverLaws, internal_forces_have_no_resultant_and_no_torque) {
  const Chain chain = random_chain(1000, 20, 1);
  const Force force = force_on(chain, *solver);
  Eigen::Matrix<long double, 3, 1> resultant, torque;
  resultant.setZero(), torque.setZero();
  long double forces = 0, torques = 0;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Eigen::Matrix<long double, 3, 1> r = chain.r()[i].cast<long double>(),
                                           f = force[i].cast<long double>();
    resultant += f, torque += r.cross(f);
    forces += f.norm(), torques += r.norm() * f.norm();
  }
  const double allowed = std::max(1e-15 * std::sqrt(1000), solver->accuracy().tolerance);
  EXPECT_LE(static_cast<double>(resultant.norm() / forces), allowed);
  EXPECT_LE(static_cast<double>(torque.norm() / torques), allowed);
}

// Numbers of beads around the lengths of vectors and tiles, of cache blocks (512) and beyond
// the number from which several threads share the work.
TEST_P(SolverLaws, any_number_of_beads_feels_the_sum_over_all_others) {
  for (const std::size_t n : {1U, 2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U, 15U, 16U, 17U, 31U, 33U,
                              150U, 511U, 512U, 513U, 1123U}) {
    const Chain chain = random_chain(n, 1, 1, static_cast<unsigned>(n));
    EXPECT_LE(worst_error(chain, force_on(chain, *solver), 150), tolerance()) << n;
    EXPECT_EQ(solver->coincident_pairs(), 0U);
  }
}

TEST_P(SolverLaws, no_bead_feels_nothing) {
  EXPECT_NO_THROW(force_on(Chain(0), *solver));
  const Force alone = force_on(Chain(1), *solver);
  EXPECT_EQ(alone[0].norm(), 0.0);
  EXPECT_EQ(solver->coincident_pairs(), 0U);
}

TEST_P(SolverLaws, the_force_is_added_to_what_is_there) {
  const Chain chain = random_chain(77, 1, 1);
  const Force once = force_on(chain, *solver);
  Force twice = once;
  solver->add_force({chain.r(), chain.q}, twice.view());
  for (std::size_t i = 0; i < chain.size(); ++i) EXPECT_EQ(twice[i], 2 * once[i]) << i;
}

TEST_P(SolverLaws, an_earlier_call_leaves_no_trace) {
  const Chain small = random_chain(20, 1, 1), large = random_chain(90, 1, 1);
  const Force fresh = force_on(small, *GetParam().make());
  force_on(large, *solver);
  EXPECT_EQ(force_on(small, *solver), fresh);
}

EHDJET_FOR_ALL_SOLVERS(SolverLaws);

} // namespace
} // namespace ehdjet::test
