#include "ehdjet/forces/force_term.hpp"

#include <algorithm>

namespace ehdjet {

TermAccount ForceTerm::account() const {
  std::string own(name());
  std::ranges::replace(own, ' ', '_');
  const std::string of = ", so far, of: " + std::string(name());
  return {.channel = {.name = own,
                      .energy = own + "_work",
                      .energy_meaning = "work on beads that move" + of,
                      .momentum = own + "_impulse",
                      .momentum_meaning = "impulse on beads that move" + of}};
}

} // namespace ehdjet
