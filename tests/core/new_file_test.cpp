#include "ehdjet/core/error.hpp"
#include "ehdjet/core/new_file.hpp"
#include "ehdjet/core/text_file.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <vector>

#include "support/folder.hpp"

namespace ehdjet {
namespace {

namespace fs = std::filesystem;

class NewFiles : public testing::Test {
protected:
  static void write(const fs::path& file, const std::string& text) {
    std::ofstream(file) << text;
  }
  static std::string text_of(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  [[nodiscard]] long entries() const {
    return std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator());
  }
  test::Folder folder_;
};

TEST_F(NewFiles, appear_when_they_are_published_and_leave_nothing_otherwise) {
  {
    NewFile file(folder_ / "a", false);
    write(file.create(), "new");
    EXPECT_FALSE(fs::exists(folder_ / "a"));
    file.publish();
  }
  EXPECT_EQ(text_of(folder_ / "a"), "new");
  {
    NewFile file(folder_ / "b", false);
    write(file.create(), "new");
  }
  EXPECT_EQ(entries(), 1);
}

TEST_F(NewFiles, replace_an_older_one_only_when_they_are_whole) {
  write(folder_ / "a", "old");
  fs::permissions(folder_ / "a", fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_THROW(NewFile(folder_ / "a", false), InputError);
  {
    NewFile file(folder_ / "a", true);
    write(file.create(), "half");
  }
  EXPECT_EQ(text_of(folder_ / "a"), "old");
  NewFile file(folder_ / "a", true);
  write(file.create(), "new");
  file.publish();
  EXPECT_EQ(text_of(folder_ / "a"), "new");
  EXPECT_EQ(fs::status(folder_ / "a").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(NewFiles, of_one_name_that_are_written_at_once_one_is_published) {
  for (int round = 0; round < 20; ++round) {
    const fs::path name = folder_ / std::to_string(round);
    std::vector<int> published(4, 0);
    std::vector<NewFile> files;
    for (std::size_t i = 0; i < published.size(); ++i) files.emplace_back(name, false);
    for (std::size_t i = 0; i < published.size(); ++i)
      write(files[i].create(), std::to_string(i));
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < published.size(); ++i)
      threads.emplace_back([&, i] {
        try {
          files[i].publish();
          published[i] = 1;
        } catch (const InputError&) { // another one was first
        }
      });
    for (std::thread& t : threads) t.join();
    std::size_t winner = 0, count = 0;
    for (std::size_t i = 0; i < published.size(); ++i)
      if (published[i] == 1) winner = i, ++count;
    ASSERT_EQ(count, 1U);
    EXPECT_EQ(text_of(name), std::to_string(winner));
  }
}

TEST_F(NewFiles, follow_links_also_to_what_is_not_there_yet) {
  fs::create_directory(folder_ / "deep");
  fs::create_symlink("deep/second", folder_ / "first");
  fs::create_symlink("third", folder_ / "deep/second");
  NewFile file(folder_ / "first", false);
  write(file.create(), "new");
  file.publish();
  EXPECT_TRUE(fs::is_symlink(folder_ / "first"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "deep/second"));
  EXPECT_EQ(text_of(folder_ / "deep/third"), "new");
}

TEST_F(NewFiles, are_refused_where_they_cannot_be) {
  EXPECT_THROW(NewFile(folder_.path(), true), InputError);
  EXPECT_THROW(NewFile(folder_ / "absent/a", true), InputError);
  write(folder_ / "a", "");
  EXPECT_THROW(NewFile(folder_ / "a/b", true), InputError);
  fs::create_symlink("loop", folder_ / "loop");
  EXPECT_THROW(NewFile(folder_ / "loop", true), InputError);
}

TEST_F(NewFiles, know_that_they_would_replace_what_is_read) {
  write(folder_ / "a", "precious");
  fs::create_symlink("a", folder_ / "link");
  fs::create_hard_link(folder_ / "a", folder_ / "hard");
  write(folder_ / "other", "precious");
  for (const char* name : {"a", "./a", "link", "hard"})
    EXPECT_THROW(refuse_input(folder_ / name, folder_ / "a"), InputError) << name;
  EXPECT_NO_THROW(refuse_input(folder_ / "other", folder_ / "a"));
  EXPECT_NO_THROW(refuse_input(folder_ / "absent", folder_ / "a"));
}

TEST_F(NewFiles, may_have_the_longest_name_and_leftovers_of_others) {
  const std::string name(255, 'n');
  for (int i = 0; i < 3; ++i) {
    NewFile file(folder_ / name, true), leftover(folder_ / name, true);
    write(leftover.create(), "");
    write(file.create(), "new");
    file.publish();
  }
  EXPECT_EQ(text_of(folder_ / name), "new");
}

std::string refusal(const fs::path& file) {
  try {
    read_text_file(file, "the text");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST_F(NewFiles, of_text_are_read_unless_they_have_no_end_or_no_writer) {
  const std::string text(100000, 'x');
  write(folder_ / "a", text);
  EXPECT_EQ(read_text_file(folder_ / "a", "the text"), text);
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_NE(refusal(folder_ / "pipe").find("nobody writes"), std::string::npos);
  EXPECT_NE(refusal("/dev/zero").find("16 MiB"), std::string::npos);
  EXPECT_NE(refusal(folder_.path()).find("folder"), std::string::npos);
  EXPECT_NE(refusal(folder_ / "absent").find("No such file"), std::string::npos);
}

} // namespace
} // namespace ehdjet
