#include "ehdjet/scene/calibration_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

#include "support.hpp"

namespace ehdjet {
namespace {

class Calibration : public testing::Test {
public:
  ~Calibration() override { std::filesystem::remove(file_); }

protected:
  Calibration()
      : file_(std::filesystem::temp_directory_path()
              / ("ehdjet_calibration." + std::to_string(::getpid()))) {}
  CostModel read_back(const std::string& text) {
    std::ofstream(file_) << text;
    return read_calibration(file_);
  }
  std::string complaint_about_text(const std::string& text) {
    return complaint([&] { read_back(text); });
  }
  std::filesystem::path file_;
};

TEST_F(Calibration, comes_back_as_it_was_written) {
  const CostModel& model = CostModel::shipped();
  const CostModel again = read_back(calibration_text(model, "here"));
  EXPECT_EQ(again.charges, model.charges);
  EXPECT_EQ(again.tolerances, model.tolerances);
  for (const double tolerance : {1e-3, 1e-7})
    for (const std::size_t n : {100U, 5000U, 300000U})
      for (const auto solver : priced_solvers)
        for (const double crowding : {0.0, 0.3, 1.0})
          EXPECT_NEAR(again.cost(solver, n, tolerance, crowding)
                          / model.cost(solver, n, tolerance, crowding),
                      1, 2e-3);
}

TEST_F(Calibration, that_is_incomplete_or_wrong_is_refused_with_file_and_key) {
  const std::string good =
      "charges = [100, 1000]\ntolerances = [1e-6, 1e-2]\n"
      "direct = [1, 2]\nfmm_jet = [1, 2, 3, 4]\nfmm_cloud = [1, 2, 3, 4]\n";
  EXPECT_EQ(complaint_about_text(good), "(accepted)");
  const auto but = [&](const std::string& piece, const std::string& by) {
    std::string text = good;
    return complaint_about_text(text.replace(text.find(piece), piece.size(), by));
  };
  expect_all(but("fmm_jet = [1, 2, 3, 4]\n", ""), {file_.string(), "fmm_jet"});
  expect_all(but("fmm_cloud = [1, 2, 3, 4]", "fmm_cloud = [1, 2, 3]"),
             {":5", "fmm_cloud", "3 numbers, must be 4"});
  expect_all(but("fmm_cloud = [1, 2", "fmm_cloud = [1, -2"), {":5", "-2", "positive"});
  expect_all(but("direct = [1, 2]", "direct = [1]"), {":3", "1 numbers, must be 2"});
  expect_all(but("fmm_jet", "treecode"), {":4", "earlier version", "ehdjet calibrate"});
  expect_all(but("[100, 1000]", "[1000, 100]"), {":1", "charges", "ascending"});
  expect_all(but("direct", "dierct"), {":3", "unknown key dierct"});
}

} // namespace
} // namespace ehdjet
