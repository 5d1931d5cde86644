#include "ehdjet/core/csv_table.hpp"

#include <sstream>
#include <string>
#include <vector>

#include "support/complaint.hpp"

namespace ehdjet {
namespace {

/// The column x of each row.
std::vector<double> read_x(const std::string& text) {
  std::istringstream in(text);
  CsvTable table(in, "table", {"x"}, {"y"});
  std::vector<double> x;
  while (table.next_row()) x.push_back(table.value(0));
  return x;
}
std::string complaint_of(const std::string& text) {
  return complaint([&] { read_x(text); });
}

TEST(CsvTable, numbers_may_have_a_plus_sign) {
  EXPECT_EQ(read_x("x,y\n+1.0e-3,0\n+2,0\n"), (std::vector{1e-3, 2.0}));
  for (const char* text : {"x\n+\n", "x\n+-1\n", "x\n++1\n"})
    expect_all(complaint_of(text), {"table:2:1: x = \"+", "must be a number"});
}

TEST(CsvTable, an_exponent_d_is_explained) {
  for (const char* text : {"y,x\n0,1.0D-3\n", "y,x\n0,-1d+3\n"})
    expect_all(complaint_of(text), {"table:2:3: x = ", "write E instead of D"});
  EXPECT_EQ(complaint_of("x\n1Day\n").find("instead"), std::string::npos);
}

TEST(CsvTable, comments_may_be_indented) {
  EXPECT_EQ(read_x("  # about it\nx,y\n \t# more\n1,2\n"), (std::vector{1.0}));
}

TEST(CsvTable, the_names_may_be_a_comment_as_numpy_writes_them) {
  EXPECT_EQ(read_x("# made with numpy\n# y,x\n1,2\n3,4\n"), (std::vector{2.0, 4.0}));
  expect_all(complaint_of("#y,x\n1,2\n3,four\n"), {"table:3:3: x = \"four\""});
  expect_all(complaint_of("# x,x\n1,2\n"), {"table:1:5: column x appears twice"});
  // A header that is no comment counts, whatever stands above it.
  EXPECT_EQ(read_x("# y,x\nx,y\n1,2\n"), (std::vector{1.0}));
  // A comment that does not name the columns is none.
  for (const char* text : {"# about x\n1,2\n", "1,2\n3,4\n"})
    expect_all(complaint_of(text), {"column x is missing", "not a comment (#)"});
}

TEST(CsvTable, other_separators_are_named) {
  expect_all(complaint_of("x;y\n0,5;0\n"), {"table:1:1: ", "semicolons", "commas"});
  expect_all(complaint_of("x\ty\n0\t1\n"), {"table:1:1: ", "tabs", "commas"});
  expect_all(complaint_of("# x y\n0.0 1.0\n"), {"table:2:1: ", "spaces", "commas"});
}

TEST(CsvTable, quotes_around_a_field_do_not_belong_to_it) {
  EXPECT_EQ(read_x("\"x\",\"name\" , y\n1,\"a, b\",2\n3, \"c\",4\n"),
            (std::vector{1.0, 3.0}));
  expect_all(complaint_of("y,x\n0,\"one\n"), {"table:2:3: x = "});
}

TEST(CsvTable, an_empty_file_is_wrong_in_its_first_line) {
  expect_all(complaint_of(""), {"table:1:1: ", "no header line"});
}

} // namespace
} // namespace ehdjet
