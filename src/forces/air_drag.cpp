#include "ehdjet/forces/air_drag.hpp"

#include "ehdjet/core/error.hpp"
#include "ehdjet/core/parallel.hpp"
#include "ehdjet/jet/curvature.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace ehdjet {
namespace {

using std::numbers::pi;

// The force is linear in w at low speed, so everything is computed from g = C Re, which is finite
// there:   rho_air a l C |w| w = (rho_air nu l/2) g(Re) w.

/// Reynolds numbers below this are as good as 0, but have a logarithm.
constexpr double still = 1e-300;
/// Where the coefficients of Marheineke & Wegener change from one form to the next.
constexpr double creeping = 0.1, fast = 100;
constexpr double oseen = 2.0022; // 2.0022 = ln 16 - (Euler's constant) + ... of that paper

/// g and d ln g/d ln Re
struct Scaled {
  double value = 0, slope = 0;
};

//     Re < 0.1    C_n = 4 pi/(S Re) (1 - Re^2 (S^2 - S/2 + 5/16)/(32 S)),   S = 2.0022 - ln Re
//     0.1 .. 100  C_n = exp(1.6911 - 0.67222 L + 0.033287 L^2 + 0.0035015 L^3),   L = ln Re
//     from 100    C_n = 2/sqrt(Re) + 0.5
struct Across {
  static constexpr double c0 = 1.6911, c1 = 1 - 0.67222, c2 = 0.033287, c3 = 0.0035015;
  static constexpr double plateau = 0.5;
  template <class T>
  static auto creeping_correction(const T& re, const T& s) {
    return re * re * (s * s - 0.5 * s + 5. / 16) / (32 * s);
  }
  template <class T>
  static auto creeping_form(const T& re, const T& s) {
    return 4 * pi / s * (1 - creeping_correction(re, s));
  }
  static double creeping_slope(double re, double s) {
    const double q = creeping_correction(re, s);
    const double ds =
        re * re * ((2 * s - 0.5) * s - (s * s - 0.5 * s + 5. / 16)) / (32 * s * s);
    return 1 / s - (2 * q - ds) / (1 - q);
  }
};

//     Re < 0.1    C_t = 4 pi/((2S-1) Re) (1 - Re^2 (2 S^2 - 2 S + 1)/(16 (2S-1)))
//     0.1 .. 100  C_t = exp(1.1552 - 0.68479 L + 0.014884 L^2 + 7.4966e-4 L^3)
//     from 100    C_t = 2/sqrt(Re)
struct Along {
  static constexpr double c0 = 1.1552, c1 = 1 - 0.68479, c2 = 0.014884, c3 = 7.4966e-4;
  static constexpr double plateau = 0;
  template <class T>
  static auto creeping_correction(const T& re, const T& s) {
    return re * re * (2 * s * s - 2 * s + 1) / (16 * (2 * s - 1));
  }
  template <class T>
  static auto creeping_form(const T& re, const T& s) {
    return 4 * pi / (2 * s - 1) * (1 - creeping_correction(re, s));
  }
  static double creeping_slope(double re, double s) {
    const double b = 2 * s - 1, q = creeping_correction(re, s);
    const double ds =
        re * re * ((4 * s - 2) * b - 2 * (2 * s * s - 2 * s + 1)) / (16 * b * b);
    return 2 / b - (2 * q - ds) / (1 - q);
  }
};

constexpr int lanes = 64;
using Block = Eigen::Array<double, lanes, 1>;

template <class Direction>
void scale(const Block& reynolds, Block& g) {
  using D = Direction;
  const Block re = reynolds.max(still);
  const Block ln = re.log();
  g = (D::c0 + ln * (D::c1 + ln * (D::c2 + ln * D::c3))).exp();
  if ((re < creeping).any()) {
    const Block s = oseen - ln;
    g = (re < creeping).select(Block(D::creeping_form(re, s)), g);
  }
  if ((re >= fast).any())
    g = (re >= fast).select(Block(2 * re.sqrt() + D::plateau * re), g);
}

template <class Direction>
Scaled scaled(double reynolds) {
  using D = Direction;
  const double re = std::max(reynolds, still), ln = std::log(re);
  if (re < creeping)
    return {D::creeping_form(re, oseen - ln), D::creeping_slope(re, oseen - ln)};
  if (re >= fast) {
    const double root = 2 * std::sqrt(re), value = root + D::plateau * re;
    return {value, (root / 2 + D::plateau * re) / value};
  }
  return {std::exp(D::c0 + ln * (D::c1 + ln * (D::c2 + ln * D::c3))),
          D::c1 + ln * (2 * D::c2 + ln * 3 * D::c3)};
}

// 0.65 pi a rho_air w_t^2 Re^(-0.81) l = rho_air 2a l C_t w_t^2
constexpr double kawai = 0.65 * pi / 2, kawai_power = 0.81;

Scaled scaled_kawai(double reynolds) {
  return {kawai * std::pow(std::max(reynolds, still), 1 - kawai_power), 1 - kawai_power};
}

/// What one end of a link feels per velocity, across and along.
struct Response {
  Scaled normal, tangential;
};
Response response(DragLaw law, double normal_reynolds, double tangential_reynolds) {
  if (law == DragLaw::tangential) return {{}, scaled_kawai(tangential_reynolds)};
  return {scaled<Across>(normal_reynolds), scaled<Along>(tangential_reynolds)};
}

/// One end of each of up to `lanes` links: the beads' velocities against the air, and what has been
/// summed for them so far.
struct Ends {
  Block wx, wy, wz, fx, fy, fz;

  /// The links from `link` on; entry i belongs to bead i.
  void feel(DragLaw law, const Links& links, std::size_t link, std::size_t count,
            const double* strength, const double* breadth) {
    const auto of = [&](const double* from) {
      Block block = Block::Zero();
      std::copy(from + link, from + link + count, block.data());
      return block;
    };
    Block length = Block::Ones();
    std::copy(links.length.data() + link, links.length.data() + link + count,
              length.data());
    const Block tx = of(links.dx.data()) / length, ty = of(links.dy.data()) / length,
                tz = of(links.dz.data()) / length;
    const Block s = of(strength), b = of(breadth);
    const Block along = wx * tx + wy * ty + wz * tz;
    Block g_along, g_across = Block::Zero();
    const Block re_along = b * along.abs();
    if (law == DragLaw::tangential) {
      g_along = kawai * re_along.max(still).pow(1 - kawai_power);
    } else {
      scale<Along>(re_along, g_along);
      const Block nx = wx - along * tx, ny = wy - along * ty, nz = wz - along * tz;
      scale<Across>(b * (nx * nx + ny * ny + nz * nz).sqrt(), g_across);
    }
    const Block across = s * g_across, turned = s * (g_along - g_across) * along;
    fx -= across * wx + turned * tx;
    fy -= across * wy + turned * ty;
    fz -= across * wz + turned * tz;
  }
};

TermAccount account_of_air() {
  return {.channel = {.name = "air",
                      .energy = "air_work",
                      .energy_meaning = "work so far of the air",
                      .momentum = "air_impulse",
                      .momentum_meaning = "so far, of the air"}};
}

} // namespace

DragCoefficients drag_coefficients(DragLaw law, double normal_reynolds,
                                   double tangential_reynolds) {
  EHDJET_EXPECTS(normal_reynolds > 0 && tangential_reynolds > 0);
  const Response r = response(law, normal_reynolds, tangential_reynolds);
  return {.normal = r.normal.value / normal_reynolds,
          .tangential = r.tangential.value / tangential_reynolds};
}

AirDrag::AirDrag(AirFlow air, DragLaw law)
    : air_(std::move(air))
    , law_(law) {}

void AirDrag::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  strength_.resize(links.length.size()), breadth_.resize(links.length.size());
  const double *l = links.length.data(), *volume = stage.volume.data();
  double *strength = strength_.data(), *breadth = breadth_.data();
  const double rho = air_.density(), nu = air_.kinematic_viscosity();
  for_parts(links.first, links.last + 1, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k) {
      strength[k] = rho * nu * l[k] / 2;
      breadth[k] = 2 * std::sqrt(volume[k] / (pi * l[k])) / nu;
    }
  });
  strength[links.last + 1] = 0, breadth[links.last + 1] = 0;

  const auto r = stage.columns.position(), v = stage.columns.velocity();
  for_parts(links.beads.begin, links.beads.end, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; k += lanes) {
      const std::size_t count = std::min<std::size_t>(lanes, end - k);
      Ends ends;
      for (Block* block : {&ends.wx, &ends.wy, &ends.wz, &ends.fx, &ends.fy, &ends.fz})
        block->setZero();
      air_.relative_velocity(
          r, v, k,
          {{ends.wx.data(), count}, {ends.wy.data(), count}, {ends.wz.data(), count}});
      ends.feel(law_, links, k, count, strength, breadth);     // the link above each bead
      ends.feel(law_, links, k + 1, count, strength, breadth); // and the one below
      for (std::size_t i = 0; i < count; ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        force.add(k + i, {ends.fx[at], ends.fy[at], ends.fz[at]});
      }
    }
  });
  if (const std::size_t k = links.head; stage.targets.begin == 0 && links.first <= k) {
    Ends ends;
    for (Block* block : {&ends.wx, &ends.wy, &ends.wz, &ends.fx, &ends.fy, &ends.fz})
      block->setZero();
    air_.relative_velocity(r, v, 0,
                           {{ends.wx.data(), 1}, {ends.wy.data(), 1}, {ends.wz.data(), 1}});
    ends.feel(law_, links, k, 1, strength, breadth);
    force.add(0, {ends.fx[0], ends.fy[0], ends.fz[0]});
  }
}

// With F = - s g(Re) w across (w = w_n) or along, dF/dw = - s g (I + d ln g/d ln Re n n^T) there.
void AirDrag::add_derivatives(const Stage& stage, LinkDerivatives& out) {
  const Links& links = stage.links();
  const auto r = stage.columns.position(), v = stage.columns.velocity();
  const double rho = air_.density(), nu = air_.kinematic_viscosity();
  for (std::size_t k = links.first; k <= links.last; ++k) {
    const double l = links.length[k];
    const double breadth = 2 * std::sqrt(stage.volume[k] / (pi * l)) / nu;
    const Vec3 t = links.vector(k) / l;
    const Mat3 along = t * t.transpose();
    for (const std::size_t end : {links.upstream(k), k}) {
      const Vec3 w = v[end] - air_.velocity(r.x[end]);
      const double w_along = w.dot(t);
      const Vec3 w_across = w - w_along * t;
      const double speed = w_across.norm();
      const auto [normal, tangential] =
          response(law_, breadth * speed, breadth * std::abs(w_along));
      Mat3 drag = normal.value * (Mat3::Identity() - along)
                  + tangential.value * (1 + tangential.slope) * along;
      if (speed > 0) {
        const Vec3 n = w_across / speed;
        drag += normal.value * normal.slope * (n * n.transpose());
      }
      out.add_drag(end, rho * nu * l / 2 * drag);
    }
  }
}

TermAccount AirDrag::account() const {
  return account_of_air();
}

AirLift::AirLift(AirFlow air)
    : air_(std::move(air)) {}

void AirLift::add_force(const Stage& stage, Vec3View force) {
  const Links& links = stage.links();
  radius_.resize(links.length.size());
  const double *l = links.length.data(), *volume = stage.volume.data();
  double* radius = radius_.data();
  for_parts(links.first, links.last + 1, [=](std::size_t begin, std::size_t end) {
#pragma omp simd
    for (std::size_t k = begin; k < end; ++k)
      radius[k] = std::sqrt(volume[k] / (pi * l[k]));
  });
  const auto r = stage.columns.position(), v = stage.columns.velocity();
  const std::size_t last = std::min(links.beads.end, stage.beads() - 1);
  for_parts(links.beads.begin, last, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 above = links.vector(k), below = links.vector(k + 1);
      const double w = (v[k] - air_.velocity(r.x[k])).dot((above + below).normalized());
      const double mean_radius = (radius[k] + radius[k + 1]) / 2;
      const double strength =
          air_.density() * (l[k] + l[k + 1]) / 2 * w * w * pi * mean_radius * mean_radius;
      force.add(k, -strength * curvature_vector(-above, below));
    }
  });
}

TermAccount AirLift::account() const {
  return account_of_air();
}

} // namespace ehdjet
