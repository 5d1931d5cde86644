#include "ehdjet/core/printable.hpp"

#include <gtest/gtest.h>

#include <string>

namespace ehdjet {
namespace {

TEST(Printable, leaves_text_as_it_is) {
  for (const std::string text :
       {"", "jet.h5", "it's 5 \xC2\xB5m \xE2\x80\x94 \xF0\x9F\x94\xA5",
        "back\\slash `$(x)`"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, shows_controls_of_a_terminal_and_ends_of_lines) {
  EXPECT_EQ(printable("a\x1b[31mb\x07"), "a\\x1b[31mb\\x07");
  EXPECT_EQ(printable("one\ntwo\r\x7f"), "one\\x0atwo\\x0d\\x7f");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xC2\x9b"
                      "31m"),
            "\\xc2\\x9b31m");                              // CSI in one character
  EXPECT_EQ(printable("\xE2\x80\xAE"), "\\xe2\\x80\\xae"); // from right to left
  EXPECT_EQ(printable("one\n\ttwo", "\n\t"), "one\n\ttwo");
}

TEST(Printable, shows_bytes_that_are_no_character) {
  EXPECT_EQ(printable("\x9b"
                      "31m"),
            "\\x9b31m");
  EXPECT_EQ(printable("\xC3"), "\\xc3");                   // cut short
  EXPECT_EQ(printable("\xC0\x9b"), "\\xc0\\x9b");          // too long a code for ESC
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80"); // half a character
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

} // namespace
} // namespace ehdjet
