#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <gmock/gmock.h>
#include <string>
#include <thread>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// Two charges of 1 and 2 nC, 0.2 mm apart, repel with 0.449377589368409 N (closed form).
TEST(Forces, reads_columns_in_any_order_and_writes_forces_in_the_same_order) {
  const Folder folder;
  folder.file("beads.csv", "q,label,z,y,x\n1e-9,first,0,0,0\n2e-9,second,0,0,2e-4\n");
  const Outcome o = command(folder, "forces beads.csv -o forces.csv");
  ASSERT_EQ(o.exit_code, 0) << o.err;
  double a[3], b[3];
  ASSERT_EQ(std::sscanf(text_of(folder / "forces.csv").c_str(),
                        "fx,fy,fz\n%lf,%lf,%lf\n%lf,%lf,%lf\n", a, a + 1, a + 2, b, b + 1,
                        b + 2),
            6);
  constexpr double expected = 0.449377589368409;
  EXPECT_NEAR(a[0], -expected, 4e-16);
  EXPECT_NEAR(b[0], expected, 4e-16);
  for (const double zero : {a[1], a[2], b[1], b[2]}) EXPECT_EQ(zero, 0);
}

TEST(Forces, reads_the_columns_that_ehdjet_writes_and_standard_input) {
  const Folder folder;
  folder.file("short.csv", "x,y,z,q\n0,0,0,1e-9\n0,0,2e-4,2e-9\n");
  folder.file("own.csv", "bead,x_m,y_m,z_m,radius_m,charge_c\n0,0,0,0,1e-6,1e-9\n"
                         "1,0,0,2e-4,1e-6,2e-9\n");
  ASSERT_EQ(command(folder, "forces short.csv -o short_forces.csv").exit_code, 0);
  ASSERT_EQ(command(folder, "forces own.csv -o own_forces.csv").exit_code, 0);
  const Outcome o = command(folder, "forces - -o piped.csv < own.csv");
  ASSERT_EQ(o.exit_code, 0) << o.err;
  const std::string forces = text_of(folder / "short_forces.csv");
  EXPECT_EQ(text_of(folder / "own_forces.csv"), forces);
  EXPECT_EQ(text_of(folder / "piped.csv"), forces);
  folder.file("own.csv", "x_m,y_m,z_m\n0,0,0\n");
  EXPECT_THAT(command(folder, "forces - < own.csv").err,
              AllOf(HasSubstr("standard input:1"), HasSubstr("q (or charge_c)")));
}

TEST(Forces, reports_cost_and_error_as_one_line_of_json) {
  const Folder folder;
  folder.file("beads.csv", "x,y,z,q\n0,0,0,1e-9\n1e-4,0,0,1e-9\n1e-4,1e-4,0,1e-9\n");
  const Outcome o = command(folder, "forces beads.csv --threads 1 --repeat 5");
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_EQ(std::ranges::count(o.out, '\n'), 1);
  EXPECT_THAT(o.out, AllOf(HasSubstr("\"n\":3"), HasSubstr("\"solver\":\"direct\""),
                           HasSubstr("\"threads\":1"), HasSubstr("\"error_l2\":0"),
                           HasSubstr("\"error_max\":0"), HasSubstr("\"seconds\":"),
                           HasSubstr("\"peak_mib\":")));
}

TEST(Forces, names_file_line_and_column_of_what_is_wrong) {
  const Folder folder;
  const auto refusal = [&](const std::string& csv, const std::string& options = "") {
    folder.file("beads.csv", csv);
    const Outcome o = command(folder, "forces beads.csv -o forces.csv " + options);
    EXPECT_EQ(o.exit_code, 2) << csv;
    EXPECT_FALSE(std::filesystem::exists(folder / "forces.csv"));
    return o.err;
  };
  EXPECT_THAT(refusal("x,y,q\n0,0,1\n"),
              AllOf(HasSubstr("beads.csv:1"), HasSubstr("column z")));
  EXPECT_THAT(refusal("x,y,z,q\n0,0,0,1\n0,0,nan,1\n"),
              AllOf(HasSubstr("beads.csv:3:5"), HasSubstr("finite")));
  EXPECT_THAT(refusal("x,y,z,q\n0,0,0,1\n0,zero,0,1\n"), HasSubstr("beads.csv:3:3"));
  EXPECT_THAT(refusal("x,y,z,q\n0,0,0,1\n0,0,1\n"), HasSubstr("3 fields"));
  EXPECT_THAT(refusal("x,y,z,q\n"), HasSubstr("no charges"));
  EXPECT_THAT(refusal("x,y,z,q\n0,0,0,1\n", "--solver fm"), HasSubstr("direct"));
  EXPECT_EQ(command(folder, "forces nowhere.csv").exit_code, 2);
}

TEST(Forces, keeps_an_existing_output_unless_forced) {
  const Folder folder;
  folder.file("beads.csv", "x,y,z,q\n0,0,0,1e-9\n1e-4,0,0,1e-9\n");
  folder.file("forces.csv", "precious");
  EXPECT_EQ(command(folder, "forces beads.csv -o forces.csv").exit_code, 2);
  EXPECT_EQ(text_of(folder / "forces.csv"), "precious");
  EXPECT_EQ(command(folder, "forces beads.csv -o forces.csv --force").exit_code, 0);
}

TEST(Forces, skips_and_reports_coincident_charges) {
  const Folder folder;
  folder.file("beads.csv", "x,y,z,q\n1e-4,0,0,1e-9\n1e-4,0,0,1e-9\n");
  const Outcome o = command(folder, "forces beads.csv -o forces.csv");
  EXPECT_EQ(o.exit_code, 0);
  EXPECT_THAT(o.err, HasSubstr("1 pair"));
  EXPECT_EQ(text_of(folder / "forces.csv"), "fx,fy,fz\n0,0,0\n0,0,0\n");
}

/// Three thousand charges along a coil, in which threads share the work.
std::string coil() {
  std::string text = "x,y,z,q\n";
  for (int i = 0; i < 3000; ++i) {
    const double t = 0.01 * i;
    text += std::to_string(std::cos(t)) + ',' + std::to_string(std::sin(t)) + ','
            + std::to_string(0.1 * t) + ",1e-9\n";
  }
  return text;
}

class ForcesOfThreads : public testing::Test {
protected:
  /// The forces as text. `before` is a setting or a command in front of `ehdjet`.
  std::string forces(const std::string& threads, const std::string& before = "") {
    last_ = command(folder_,
                    "forces beads.csv --solver fmm --no-check -o f.csv --force --threads "
                        + threads,
                    before);
    EXPECT_EQ(last_.exit_code, 0) << last_.err;
    return text_of(folder_ / "f.csv");
  }
  const Folder folder_;
  const std::string beads_ = folder_.file("beads.csv", coil());
  Outcome last_;
};

TEST_F(ForcesOfThreads, have_the_bits_of_their_number_on_any_machine) {
  const std::string many = std::to_string(std::thread::hardware_concurrency() + 1);
  const std::string expected = forces(many);
  ASSERT_NE(expected, forces("1")) << "a test of bits that never differ shows nothing";
  EXPECT_EQ(forces(many), expected);
  EXPECT_EQ(forces(many, "OMP_DYNAMIC=true"), expected);
  EXPECT_THAT(last_.out, HasSubstr("\"threads\":" + many));
  const std::string processor = "$(taskset -cp $$ | sed 's/.*: //; s/[,-].*//')";
  EXPECT_EQ(forces(many, "taskset -c " + processor), expected);
  EXPECT_EQ(forces(many, "OMP_WAIT_POLICY=passive"), expected);

  std::atomic<bool> busy = true;
  const auto work = [&busy] {
    while (busy) {
    }
  };
  const std::array<std::jthread, 2> load{std::jthread(work), std::jthread(work)};
  EXPECT_EQ(forces(many), expected);
  busy = false;
}

TEST_F(ForcesOfThreads, tell_how_many_ran_if_there_is_a_limit) {
  const std::string alone = forces("1");
  EXPECT_THAT(last_.err, Not(HasSubstr("OMP_THREAD_LIMIT")));
  EXPECT_EQ(forces("8", "OMP_THREAD_LIMIT=1"), alone);
  EXPECT_THAT(last_.out, HasSubstr("\"threads\":1,"));
  EXPECT_THAT(last_.err,
              HasSubstr("1 thread runs instead of 8, because of OMP_THREAD_LIMIT"));
}

TEST(Forces, without_a_check_leave_the_errors_out) {
  const Folder folder;
  folder.file("beads.csv", coil());
  const std::string line = "forces beads.csv --solver fmm --tolerance 1e-3 ";
  EXPECT_THAT(command(folder, line).out, HasSubstr("\"error_l2\":"));
  const Outcome o = command(folder, line + "--no-check");
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_THAT(o.out, AllOf(HasSubstr("\"seconds\":"), Not(HasSubstr("error"))));
}

// A knot has nearly all of |F|^2. Along the line the pair forces cancel, so that a force may be off by
// per cents although every force keeps the tolerance that it can have.
TEST(Forces, tell_what_a_tight_knot_hides) {
  const Folder folder;
  std::string text = "x,y,z,q\n";
  constexpr int knot = 256, beads_in_it = 8; // all of them in the sample of the solver
  for (int i = 0; i < 8192; ++i) {
    const bool tied = i >= knot && i < knot + beads_in_it;
    text += std::to_string(tied ? knot * 1000 + i - knot : i * 1000) + "e-7,0,0,1e-12\n";
  }
  folder.file("beads.csv", text);
  const auto figure = [](const Outcome& o, const std::string& name) {
    const std::size_t at = o.out.find('"' + name + "\":");
    return at == std::string::npos ? NAN : std::stod(o.out.substr(at + name.size() + 3));
  };
  const std::string line = "forces beads.csv --solver fmm --tolerance 1e-6 ";
  const Outcome global = command(folder, line),
                per_bead = command(folder, line + "--norm per-bead");
  EXPECT_THAT(global.err, HasSubstr("--norm per-bead"));
  EXPECT_LT(figure(global, "error_l2"), 1e-6);
  EXPECT_GT(figure(global, "error_max"), 1e-6);
  EXPECT_GT(figure(global, "error_of_net_median"), 1e-4);
  EXPECT_THAT(per_bead.err, IsEmpty());
  EXPECT_LT(figure(per_bead, "error_max"), 1e-6);
  EXPECT_LT(figure(per_bead, "error_of_net_median"),
            figure(global, "error_of_net_median") / 10);
  EXPECT_GE(figure(per_bead, "error_of_net_max"), figure(per_bead, "error_of_net_median"));
}

} // namespace
