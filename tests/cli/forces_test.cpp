#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <gmock/gmock.h>
#include <string>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::HasSubstr;

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

} // namespace
