// Numbers are cut out of the source text.
#include "files/toml/value.hpp"
#include "system_text.hpp"

namespace carom::tests {
namespace {

using files::Value;

TEST(TomlText, NumbersKeepTheirText) {
  const Value root = files::parse_document(
      "\xEF\xBB\xBFtitle = \"é ü 𝛑\"\n"
      "\"ключ\" = { x = [ 0.1, -2.50e3 , 1_000 ], \"ü\" = \"ééé\", y = 0.30 } # é\n"
      "\t[a.b]\n"
      "n = 0x1F\n"
      "m=+7\n"
      "[[q]]\n"
      "v = [\n  1.50,\n  2.250 ]\n",
      "test.toml");
  const Value& inline_table = *root.find("ключ");
  EXPECT_EQ(inline_table.find("x")->items[0].text, "0.1");
  EXPECT_EQ(inline_table.find("x")->items[1].text, "-2.50e3");
  EXPECT_EQ(inline_table.find("x")->items[2].text, "1_000");
  EXPECT_EQ(inline_table.find("y")->text, "0.30");
  EXPECT_EQ(root.find("a")->find("b")->find("n")->text, "31");
  EXPECT_EQ(root.find("a")->find("b")->find("m")->text, "+7");
  const Value& v = *root.find("q")->items[0].find("v");
  EXPECT_EQ(v.items[0].text, "1.50");
  EXPECT_EQ(v.items[1].text, "2.250");
  EXPECT_EQ(v.items[1].place.line, 9);
  EXPECT_EQ(v.items[1].place.column, 3);
  EXPECT_EQ(v.items[1].place.key, "q[0].v[1]");
}

TEST(TomlText, WindowsLineEndsAreFine) {
  const Value root = files::parse_document("a = 0.10\r\nb = 2.0\r\n", "test.toml");
  EXPECT_EQ(root.find("a")->text, "0.10");
  EXPECT_EQ(root.find("b")->text, "2.0");
}

TEST(TomlText, OneTenthMeansOneTenth) {
  const System system = read(square("[particles]\nspeed = 0.1\n"));
  EXPECT_EQ(system.particles[0].speed, 0.1);
  // 2^53 + 1 + 2^-60 rounds up; a detour over the nearest double 2^53 would not.
  const std::string digits = "9007199254740993.000000000000000001";
  EXPECT_EQ(read(square("[particles]\nspeed = " + digits)).particles[0].speed, 9007199254740994.0);
}

TEST(TomlText, SyntaxErrorsHaveTheirPlace) {
  EXPECT_EQ(fault("[table]\nshape = \n").place().line, 2);
  EXPECT_EQ(fault("[table]\nshape = \n").place().column, 9);
  EXPECT_EQ(fault("a = 1\na = 2\n").place().line, 2);
  EXPECT_EQ(fault("[table\n").place().line, 1);
}

TEST(TomlText, ValuesFromTheCommandLine) {
  const Place place{"command line", 0, 0, "--set"};
  EXPECT_EQ(files::parse_value("0.10", place).text, "0.10");
  EXPECT_EQ(files::parse_value("0.10", place).kind, Value::Kind::number);
  EXPECT_EQ(files::parse_value("true", place).kind, Value::Kind::boolean);
  for (const char* word : {"1/3", "circle", ".5", "1\nb = 2", "# 3", "", "[1"}) {
    EXPECT_EQ(files::parse_value(word, place).kind, Value::Kind::text) << word;
    EXPECT_EQ(files::parse_value(word, place).text, word);
  }
  const Value list = files::parse_value("[[0, 0.10], [1, \"1/3\"]]", place);
  ASSERT_EQ(list.items.size(), 2u);
  EXPECT_EQ(list.items[0].items[1].text, "0.10");
  EXPECT_EQ(list.items[1].place.file, "command line");
}

TEST(TomlText, WhatIsPrintedReadsBack) {
  const std::string text =
      "title = \"a \\\"b\\\" \\\\ \\u0001 é\"\n\n[table]\nlist = [1.50, [\"x\", true], {a = 1, \"b "
      "c\" = "
      "[]}]\n\n"
      "[[table.hole]]\nw = 1\n\n[[table.hole]]\nw = 2\n\n[run]\nt = 1e3\n";
  EXPECT_EQ(files::print_document(files::parse_document(text, "a")), text);
}

}  // namespace
}  // namespace carom::tests
