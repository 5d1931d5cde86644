#include "ehdjet/budget/balance.hpp"

#include "ehdjet/core/compensated_sum.hpp"
#include "ehdjet/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ehdjet {
namespace {

constexpr std::size_t none = static_cast<std::size_t>(-1);

std::size_t index_of(std::span<const Channel> channels, const std::string& name) {
  const auto found = std::ranges::find(channels, name, &Channel::name);
  return found == channels.end() ? none
                                 : static_cast<std::size_t>(found - channels.begin());
}

const Channel nozzle{.name = "nozzle",
                     .energy = "nozzle_work",
                     .energy_meaning =
                         "work so far of moving the nozzle and of feeding its link",
                     .momentum = "nozzle_impulse",
                     .momentum_meaning = "so far, of the nozzle on the jet"};
const Channel held{.name = "held",
                   .energy = "held_work",
                   .energy_meaning = "work so far of the held ends",
                   .momentum = "held_impulse",
                   .momentum_meaning = "so far, of the held ends on the chain"};

} // namespace

double JetEnergies::total() const {
  return std::accumulate(stored.begin(), stored.end(), kinetic);
}

Balance::Balance(const JetDynamics& dynamics,
                 std::span<const std::unique_ptr<Event>> events)
    : dynamics_(dynamics) {
  const Constraints& constraints = dynamics.constraints();
  chain_.constrain(constraints), chain_before_.constrain(constraints);
  for (const auto& term : dynamics.terms()) {
    accounts_.push_back(term->account());
    const TermAccount& account = accounts_.back();
    store_of_.push_back(none);
    if (!account.energy.empty()) {
      const auto known = std::ranges::find(stores_, account.energy, &TermAccount::energy);
      store_of_.back() = static_cast<std::size_t>(known - stores_.begin());
      if (known == stores_.end()) stores_.push_back(account);
    }
    if (!account.channel.name.empty()) add_channel(account.channel);
    own_.push_back(index_of(channels_, account.channel.name));
    const auto columns = term->columns();
    if (std::ranges::any_of(columns,
                            [](const BeadColumn& c) { return c.drying.has_value(); }))
      drying_ = own_.size() - 1;
  }
  if (constraints.inflow != nullptr) add_channel(nozzle);
  if (constraints.ends.first || constraints.ends.last) add_channel(held);
  for (const auto& event : events) add_channel(event->channel());
  support_channel_.fill(none);
  const auto support = [&](Support s, const char* name) {
    support_channel_[static_cast<std::size_t>(s)] = index_of(channels_, name);
  };
  support(Support::inflow, "nozzle"), support(Support::insertion, "insertion");
  support(Support::collector, "landing"), support(Support::clamp, "held");
  flows_.resize(channels_.size());
}

void Balance::add_channel(const Channel& channel) {
  if (index_of(channels_, channel.name) == none) channels_.push_back(channel);
}

std::size_t Balance::channel(const std::string& name) const {
  const std::size_t index = index_of(channels_, name);
  EHDJET_EXPECTS(index != none);
  return index;
}

void Balance::prescribe(JetState& jet) const {
  if (const Inflow* inflow = chain_.constraints().inflow)
    inflow->prescribe(jet.time, jet.has_embryo, jet.columns());
}

const Stage& Balance::look_at(ActingChain& chain, const JetState& jet) {
  chain.bind(jet);
  return chain.at(jet.time, jet.y);
}

JetEnergies Balance::motion_of(const ActingChain& chain) {
  JetEnergies e;
  const Stage& stage = chain.stage();
  const auto v = stage.columns.velocity();
  for (std::size_t k = 0; k < stage.beads(); ++k) {
    if (stage.moves[k] == 0) continue;
    e.momentum += stage.mass[k] * v[k];
    e.momentum_size += stage.mass[k] * v[k].norm();
    e.kinetic += stage.mass[k] * v[k].squaredNorm() / 2;
  }
  return e;
}

JetEnergies Balance::energies(const JetState& jet) {
  const Stage& stage = look_at(chain_, jet);
  JetEnergies e = motion_of(chain_);
  const auto& terms = dynamics_.terms();
  e.stored.assign(stores_.size(), 0.0);
  for (std::size_t i = 0; i < terms.size(); ++i)
    if (store_of_[i] != none) e.stored[store_of_[i]] += terms[i]->energy(stage);
  return e;
}

Flow Balance::jump(const JetState& before, const JetState& after) {
  const Stage& then = look_at(chain_before_, before);
  const Stage& now = look_at(chain_, after);
  const JetEnergies a = motion_of(chain_before_), b = motion_of(chain_);
  Flow flow{.energy = b.kinetic - a.kinetic, .momentum = b.momentum - a.momentum};
  for (const auto& term : dynamics_.terms()) flow.energy += term->energy_change(then, now);
  return flow;
}

std::span<const Flow> Balance::flows(const JetState& jet) {
  const Stage& stage = look_at(chain_, jet);
  const std::size_t n = stage.beads();
  support_of_.resize(n);
  for (std::size_t k = 0; k < n; ++k) support_of_[k] = chain_.support(k);
  Exchange exchange{.support_of = support_of_,
                    .led_velocity = {},
                    .plate_velocity = chain_.constraints().plate_velocity,
                    .own = {},
                    .supported = {}};
  for (Vec3& v : exchange.led_velocity) v.setZero();
  const Inflow* inflow = chain_.constraints().inflow;
  if (inflow != nullptr) {
    exchange.led_velocity[0] = stage.columns.velocity()[0];
    exchange.led_velocity[0].x() = 0; // the fluid flows through the nozzle, which stays
  }
  if (inflow != nullptr && chain_.has_led_bead())
    exchange.led_velocity[1] = inflow->led_velocity(stage.columns);
  std::ranges::fill(flows_, Flow{});
  const auto& terms = dynamics_.terms();
  for (std::size_t i = 0; i < terms.size(); ++i) {
    exchange.own = {};
    add_flows(chain_, *terms[i], accounts_[i], exchange);
    if (own_[i] == none) continue;
    flows_[own_[i]].energy += exchange.own.energy;
    flows_[own_[i]].momentum += exchange.own.momentum;
  }
  for (std::size_t s = 0; s < supports; ++s) {
    if (support_channel_[s] == none) continue;
    Flow& flow = flows_[support_channel_[s]];
    flow.energy += exchange.supported[s].energy;
    flow.momentum += exchange.supported[s].momentum;
  }
  if (drying_) {
    const Flow vapour = drying(jet);
    flows_[own_[*drying_]].energy += vapour.energy;
    flows_[own_[*drying_]].momentum += vapour.momentum;
  }
  return flows_;
}

// By a central difference over a change of 1e-5 of the volume: a formula for each law of the stress, the
// surface and the near field would say the same.
Flow Balance::drying(const JetState& jet) {
  constexpr double change = 1e-5;
  const std::size_t n = jet.beads(), place = jet.table->drying()->column;
  Stage stage = chain_.stage();
  stage.feed = nullptr; // the fresh fluid that is mixed in comes with the feed
  rates_.assign(jet.y.size(), 0.0);
  const JetColumns<double> rates{rates_, n};
  dynamics_.terms()[*drying_]->set_column_rates(stage, rates);
  const std::span<double> rate = rates.column(place);
  rate[0] = 0;
  for (const std::size_t k : chain_.frozen()) rate[k] = 0;
  double largest = 0;
  for (const double r : rate) largest = std::max(largest, std::abs(r));
  if (largest == 0) return {};
  const double dt = change / largest;
  const auto after = [&](double time) {
    changed_ = jet.y;
    const std::span<double> lost = JetColumns<double>{changed_, n}.column(place);
    for (std::size_t k = 0; k < n; ++k) lost[k] += time * rate[k];
    return content_of_masses(jet.time, changed_);
  };
  const Flow later = after(dt), earlier = after(-dt);
  return {.energy = (later.energy - earlier.energy) / (2 * dt),
          .momentum = (later.momentum - earlier.momentum) / (2 * dt)};
}

Flow Balance::content_of_masses(double t, std::span<const double> y) {
  const Stage& stage = chain_.at(t, y);
  const JetEnergies motion = motion_of(chain_);
  Flow content{.energy = motion.kinetic, .momentum = motion.momentum};
  const auto& terms = dynamics_.terms();
  for (std::size_t i = 0; i < terms.size(); ++i)
    if (store_of_[i] != none && !accounts_[i].of_charges_only)
      content.energy += terms[i]->energy(stage);
  return content;
}

// With the force f of a term and its energy U,
//
//     d/dt (kinetic energy + U) = sum of f.v over beads that move + dU/dt
//                               = - sum of f.dr/dt over beads that are led
//                                 + dU/dt by what bead 1 carries
//
// plus what the term itself says it exchanges. Without energy the first sum is what it brings in.
void Balance::add_flows(const ActingChain& chain, ForceTerm& term,
                        const TermAccount& account, Exchange& exchange) {
  const Stage& stage = chain.stage();
  const std::size_t n = stage.beads();
  const bool stores = !account.energy.empty() || account.tells_all_power,
             is_external = !account.channel.momentum.empty();
  force_.assign(3 * n, 0.0);
  const std::span<double> f(force_);
  const Vec3View force{f.subspan(0, n), f.subspan(n, n), f.subspan(2 * n, n)};
  if (stores && !is_external)
    term.add_force_on(chain.held(), stage, force);
  else
    term.add_force(stage, force);
  for (const std::size_t k : chain.held()) {
    Flow& support = exchange.by_support_of(k);
    if (stores) support.energy -= force[k].dot(exchange.led(k));
    if (!is_external) support.momentum -= force[k];
  }
  if (!stores || is_external) {
    const auto v = stage.columns.velocity();
    for (std::size_t k = 0; k < n; ++k) {
      if (stage.moves[k] == 0) continue;
      if (!stores) exchange.own.energy += force[k].dot(v[k]);
      if (is_external) exchange.own.momentum += force[k];
    }
  }
  const Inflow* inflow = chain.constraints().inflow;
  if (stores && chain.changes_content())
    exchange.by_inflow().energy += term.feeding_power(
        stage, inflow->content_rate(chain.full_content(), stage.columns));
  term.add_power(stage, exchange);
}

JetTotals Balance::totals(const JetState& jet, bool with_coulomb_energy) {
  const Stage& stage = look_at(chain_, jet);
  const JetEnergies motion = motion_of(chain_);
  CompensatedSum mass, charge, volume;
  for (std::size_t k = 1; k < jet.beads(); ++k)
    mass += jet.mass[k], charge += jet.charge[k], volume += jet.volume[k];
  JetTotals totals{.mass = mass, .charge = charge, .volume = volume};
  totals.momentum = motion.momentum, totals.kinetic_energy = motion.kinetic;
  for (std::size_t i = 0; i < accounts_.size(); ++i) {
    ForceTerm& term = *dynamics_.terms()[i];
    if (accounts_[i].energy == "elastic_energy")
      totals.elastic_energy += term.energy(stage);
    const std::string& energy = accounts_[i].energy;
    if (with_coulomb_energy
        && (energy == "coulomb_energy" || energy == "mat_energy" || energy == "image_energy"
            || energy == "near_field_energy" || energy == "softening_energy"))
      totals.coulomb_energy += term.energy(stage);
  }
  return totals;
}

} // namespace ehdjet
