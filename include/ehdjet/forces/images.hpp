#pragma once

#include "ehdjet/coulomb/solver.hpp"
#include "ehdjet/forces/force_term.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace ehdjet {

/// The conducting planes in which the charges of a jet have images: the collector x = h, or also the
/// plate of the nozzle, x = 0 (model 3.2).
struct Mirrors {
  double distance = 0;      ///< h [m]
  bool both_plates = false; ///< else only the collector
};

/// A straight piece of jet in front of a mirror.
struct MirroredPiece {
  double charge = 0; ///< q [C]
  double x = 0;      ///< its place [m]
  double length = 0; ///< l; 0: a point charge [m]
  double radius = 0; ///< a: it does not come closer to its image than 2 a [m]
};

/// The force on a piece of jet by its own images, along x [N]:
///
///     f(d) = k_C q^2/(2 D sqrt(4 D^2 + l^2/4)),   D = max(d, a),   of the nearest image, at 2 d
///     collector       F = f(h - x)
///     both plates     F = f(h - x) - f(x) - k_C q^2/(4 h^2) (psi1(1 + x/h) - psi1(2 - x/h))
///
/// For l = a = 0 the second is - k_C q^2/(4 h^2) (psi1(x/h) - psi1(1 - x/h)), psi1 the trigamma function: the
/// sum over all images of a point charge.
/// source : Jackson, Classical Electrodynamics, 3rd ed. (1999), ch. 2
[[nodiscard]] double own_image_force(const MirroredPiece& piece, const Mirrors& mirrors);

/// The forces on all charges by the images of all others (model 3.2): charges -q at 2 h - x and, with
/// both plates, all images of period 2 h, of which three on each side of both kinds are summed. What
/// the rest does is expanded to second order in place.
///
/// cost   : one call of CoulombSolver::add_force_from, in which the sources are the images: n of them, or
///          12 n with both plates
class ImageForce final : public ForceTerm {
public:
  ImageForce(const Mirrors& mirrors, std::unique_ptr<CoulombSolver> solver);
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] std::string_view name() const override { return "images"; }
  [[nodiscard]] TermAccount account() const override;
  [[nodiscard]] double energy(const Stage& stage) override; ///< half the sum of q phi
  [[nodiscard]] double feeding_power(const Stage& stage, const LinkContent& rate) override;
  void archive(const Archive& a) override { solver_->archive(a.part("solver")); }

private:
  /// Where a charge has an image, and its sign: x' = shift + direction x.
  struct Image {
    double shift = 0;     // [m]
    double direction = 1; // and sign
  };
  /// Sums over charges, places measured from the middle between the plates.
  struct Moments {
    double charge = 0;
    Vec3 dipole = Vec3::Zero();
    double along = 0, across = 0; // sum of q xi^2 and of q (y^2 + z^2)
  };

  void mirror(const Stage& stage);
  [[nodiscard]] double seen_at(double x) const;
  [[nodiscard]] Vec3 middle(const Vec3& r) const;
  [[nodiscard]] Moments moments(const Stage& stage) const;
  [[nodiscard]] Moments moments(const Vec3& from_middle, double charge) const;
  void correct(const Stage& stage, BeadRange targets, Vec3View force) const;
  [[nodiscard]] Vec3 rest_field(const Moments& of, const Vec3& from_middle) const;
  [[nodiscard]] double rest_potential(const Moments& of, const Vec3& from_middle) const;
  [[nodiscard]] Vec3 field_of_others(const Stage& stage, std::size_t bead) const;
  [[nodiscard]] double potential_of_others(const Stage& stage, std::size_t bead,
                                           const Moments& all) const;

  Mirrors mirrors_;
  std::vector<Image> images_;
  double even_ = 0, odd_ = 0, constant_ = 0; // sums over all images that are not listed
  std::unique_ptr<CoulombSolver> solver_;
  std::vector<double> x_, y_, z_, charge_; // of the images
  std::vector<double> seen_, target_;      // x of the targets between the plates; charges
  std::vector<std::size_t> close_; // targets so close to a plate that they are summed alone
};

/// The forces of each bead's own images (`own_image_force`), as a piece of jet of the length of its
/// link. Its work has columns in a budget, not an energy, because the length changes.
class OwnImages final : public ForceTerm {
public:
  explicit OwnImages(const Mirrors& mirrors)
      : mirrors_(mirrors) {}
  void add_force(const Stage& stage, Vec3View force) override;
  [[nodiscard]] std::string_view name() const override { return "own images"; }

private:
  Mirrors mirrors_;
};

} // namespace ehdjet
