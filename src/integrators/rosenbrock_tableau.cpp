#include "ehdjet/integrators/rosenbrock_tableau.hpp"

#include <array>

namespace ehdjet {
namespace {

const RosenbrockTableau ros34pw2{
    .name = "ros34pw2",
    .description =
        "Rosenbrock-W of order 3(2), L-stable (Rang & Angermann, BIT 45 (2005) 761)",
    .order = 3,
    .error_order = 3,
    .gamma = 4.3586652150845900e-1,
    .a = {{},
          {8.7173304301691801e-1},
          {8.4457060015369423e-1, -1.1299064236484185e-1},
          {0, 0, 1}},
    .g = {{},
          {-8.7173304301691801e-1},
          {-9.0338057013044082e-1, 5.4180672388095326e-2},
          {2.4212380706095346e-1, -1.2232505839045147, 5.4526025533510214e-1}},
    .b = {2.4212380706095346e-1, -1.2232505839045147, 1.5452602553351020,
          4.3586652150845900e-1},
    .embedded = {3.7810903145819369e-1, -9.6042292212423178e-2, 0.5,
                 2.1793326075422950e-1}};

const std::array tableaus{ros34pw2};

} // namespace

std::span<const RosenbrockTableau> rosenbrock_tableaus() {
  return tableaus;
}

} // namespace ehdjet
