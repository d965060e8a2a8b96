// Texts of strangers as they are shown.
#include "base/printable.hpp"

#include <gtest/gtest.h>

#include <string>

#include "carom/base/error.hpp"

namespace carom {
namespace {

using base::Lines;
using base::printable;

TEST(Printable, ShowsWhatActs) {
  EXPECT_EQ(printable("Müller's π ⊂ 𝔹, κ = 1/2 $x$"), "Müller's π ⊂ 𝔹, κ = 1/2 $x$");
  EXPECT_EQ(printable("a\x1b]0;title\x07z\x7f"), "a\\x1b]0;title\\x07z\\u007f");
  EXPECT_EQ(printable("a\xc2\x9b"
                      "31m"),
            "a\\u009b31m");  // CSI in one character
  EXPECT_EQ(printable("a\u202eb\u2066c\ufeff"), "a\\u202eb\\u2066c\\ufeff");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("a\nb\tc"), "a\\nb\\x09c");
  EXPECT_EQ(printable("a\nb\tc\r", Lines::many), "a\nb\tc\\x0d");
}

TEST(Printable, ShowsBytesThatAreNoText) {
  EXPECT_EQ(printable("a\xff"), "a\\xff");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");           // written longer than needed
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // half of a pair
  EXPECT_EQ(printable("\xe2\x82"), "\\xe2\\x82");           // cut
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
}

TEST(Printable, MessagesAreOneLine) {
  const InputError error(Place{"a\x1b.toml", 1, 2, "x\ny"}, "no\r");
  EXPECT_STREQ(error.what(), "a\\x1b.toml, line 1, column 2: x\\ny: no\\x0d");
  EXPECT_EQ(error.place().key, "x\ny");
}

}  // namespace
}  // namespace carom
