#include "ehdjet/io/export.hpp"

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
  output.print(
      "time_s,beads,tip_x_m,tip_yz_m,path_length_m,nozzle_speed_m_s,impact_speed_m_s,"
      "collector_radius_m,current_in_a,current_out_a,aperture_deg,evaluations,steps,"
      "rejected\n");
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
      "radius_m,mass_kg,charge_c,volume_m3\n");
  for (std::size_t k = 0; k < d.beads(); ++k) {
    output.print("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},",
                 d.time[k], d.removal_time[k], d.x[k], d.y[k], d.z[k], d.vx[k], d.vy[k],
                 d.vz[k]);
    output.print("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", d.stress[k],
                 d.landing_radius[k], d.radius[k], d.mass[k], d.charge[k], d.volume[k]);
  }
  output.close();
}

} // namespace ehdjet
