#include "ehdjet/core/error.hpp"
#include "ehdjet/io/export.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "selected_frames.hpp"

namespace ehdjet {

void export_observables(const RunReader& run, TextOutput& output) {
  // Their names in the file, and the headers, in the same order.
  static constexpr const char* columns[] = {
      "time",        "beads",        "tip_x",        "tip_yz",
      "path_length", "nozzle_speed", "impact_speed", "collector_radius",
      "current_in",  "current_out",  "aperture",     "evaluations",
      "steps",       "rejected"};
  std::vector<std::vector<double>> values;
  for (const char* column : columns) values.push_back(run.observable(column));
  const auto present = run.columns();
  const bool with_error = std::ranges::find(present, "coulomb_error") != present.end();
  if (with_error) values.push_back(run.observable("coulomb_error"));
  output.print(
      "time_s,beads,tip_x_m,tip_yz_m,path_length_m,nozzle_speed_m_s,impact_speed_m_s,"
      "collector_radius_m,current_in_a,current_out_a,aperture_deg,evaluations,steps,"
      "rejected{}\n",
      with_error ? ",coulomb_error" : "");
  for (std::size_t row = 0; row < values.front().size(); ++row) {
    for (std::size_t c = 0; c < values.size(); ++c) {
      output.print("{}{:.17g}", c == 0 ? "" : ",", values[c][row]);
    }
    output.print("\n");
  }
  output.close();
}

void export_beads(const RunReader& run, std::optional<double> time, TextOutput& output) {
  const Frame f = run.frame(selected_frame(run, time));
  output.print(
      "bead,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,stress_pa,radius_m,volume_m3,mass_kg,charge_c,"
      "landed,embryo\n");
  for (std::size_t k = 0; k < f.beads(); ++k) {
    output.print("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},", k, f.x[k],
                 f.y[k], f.z[k], f.vx[k], f.vy[k], f.vz[k], f.stress[k]);
    output.print("{:.17g},{:.17g},{:.17g},{:.17g},{},{}\n", f.radius[k], f.volume[k],
                 f.mass[k], f.charge[k], f.landed[k], f.embryo[k]);
  }
  output.close();
}

void export_deposit(const RunReader& run, TextOutput& output) {
  const DepositTable d = run.deposit();
  output.print(
      "time_s,removal_time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,stress_pa,landing_radius_m,"
      "radius_m,mass_kg,charge_c,volume_m3,arc_length_m\n");
  double arc_length = 0;
  for (std::size_t k = 0; k < d.beads(); ++k) {
    arc_length += d.volume[k] / (std::numbers::pi * d.radius[k] * d.radius[k]);
    output.print("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},",
                 d.time[k], d.removal_time[k], d.x[k], d.y[k], d.z[k], d.vx[k], d.vy[k],
                 d.vz[k]);
    output.print("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", d.stress[k],
                 d.landing_radius[k], d.radius[k], d.mass[k], d.charge[k], d.volume[k],
                 arc_length);
  }
  output.close();
}

void export_refinements(const RunReader& run, TextOutput& output) {
  const RefinementTable t = run.refinements();
  const bool with_coulomb = !t.coulomb_energy.empty();
  output.print("time_s,kept,beads_before,beads_after,mass_change_kg,charge_change_c,"
               "volume_change_m3,momentum_change_x_kg_m_s,momentum_change_y_kg_m_s,"
               "momentum_change_z_kg_m_s,kinetic_energy_change_j,elastic_energy_change_j,"
               "{}worst_link\n",
               with_coulomb ? "coulomb_energy_change_j," : "");
  for (std::size_t i = 0; i < t.time.size(); ++i) {
    output.print("{:.17g},{},{},{},{:.17g},{:.17g},{:.17g},", t.time[i], t.kept[i],
                 t.beads_before[i], t.beads_after[i], t.mass[i], t.charge[i], t.volume[i]);
    output.print("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},", t.px[i], t.py[i], t.pz[i],
                 t.kinetic_energy[i], t.elastic_energy[i]);
    if (with_coulomb) output.print("{:.17g},", t.coulomb_energy[i]);
    output.print("{:.17g}\n", t.worst_link[i]);
  }
  output.close();
}

void export_budget(const RunReader& run, TextOutput& output) {
  const BudgetTable t = run.budget();
  output.print("time_s");
  for (std::size_t c = 0; c < t.names.size(); ++c) {
    const std::string& unit = t.units[c];
    output.print(",{}{}", t.names[c], unit == "J" ? "_j" : unit == "1" ? "" : "_kg_m_s");
  }
  output.print("\n");
  for (std::size_t i = 0; i < t.time.size(); ++i) {
    output.print("{:.17g}", t.time[i]);
    for (const auto& column : t.columns) output.print(",{:.17g}", column[i]);
    output.print("\n");
  }
  output.close();
}

void export_resolving_power(const RunReader& run, std::optional<double> from,
                            TextOutput& output) {
  const ResolvingPowerTable t = run.resolving_power();
  const std::size_t places = t.lambda.size();
  const double start = from.value_or(t.time.empty() ? 0 : t.time.back() / 2);
  const auto first =
      static_cast<std::size_t>(std::ranges::lower_bound(t.time, start) - t.time.begin());
  if (first == t.time.size())
    throw InputError(fmt::format("{} has no sample of the resolving power from {} s on",
                                 run.path().string(), start));
  output.print("lambda,mean_r,min_r\n");
  for (std::size_t i = 0; i < places; ++i) {
    double sum = 0, least = std::numeric_limits<double>::infinity();
    for (std::size_t k = first; k < t.time.size(); ++k) {
      sum += t.r[k * places + i];
      least = std::min(least, t.r[k * places + i]);
    }
    output.print("{:.17g},{:.17g},{:.17g}\n", t.lambda[i],
                 sum / static_cast<double>(t.time.size() - first), least);
  }
  output.close();
}

} // namespace ehdjet
