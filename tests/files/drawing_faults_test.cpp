// What is wrong with a drawing is said with its line and column; damaged drawings are refused or
// read.
#include <fstream>
#include <sstream>

#include "carom/table/table.hpp"
#include "damaged.hpp"
#include "files/svg/drawing.hpp"
#include "files/toml/read.hpp"
#include "scratch_folder.hpp"
#include "system_text.hpp"

namespace carom::tests {
namespace {

InputError fault_of(const std::string& svg) {
  try {
    files::loops_of_drawing(svg, "d.svg", 1);
  } catch (const InputError& error) {
    return error;
  }
  return InputError("no fault");
}

struct Fault {
  const char* svg;
  int line, column;
};

TEST(DrawingFaults, HaveLineAndColumn) {
  const Fault faults[] = {
      // XML
      {"", 1, 1},
      {"just text", 1, 1},
      {"<svg", 1, 1},
      {"<svg><g></svg>", 1, 9},
      {"<svg>\n <circle r='1'>", 2, 16},
      {"<svg></svg><svg/>", 1, 12},
      {"<svg></svg></g>", 1, 12},
      {"<svg><!-- no end", 1, 6},
      {"<svg><![CDATA[ no end", 1, 6},
      {"<svg><? no end", 1, 6},
      {"<!DOCTYPE svg [ <!ENTITY a \"b\"> ", 1, 1},
      {"<svg>\n<circle r=1/></svg>", 2, 11},
      {"<svg>\n<circle r/></svg>", 2, 10},
      {"<svg>\n<circle r='1/></svg>", 2, 11},
      {"<svg>\n<circle r='1' r='2'/></svg>", 2, 15},
      {"<svg>\n<circle r='1'r='2'/></svg>", 2, 14},
      {"<svg><é é='ü'/>< /></svg>", 1, 6},
      {"<svg>< /></svg>", 1, 7},
      {"<html></html>", 1, 1},
      {"<svg><svg/></svg>", 1, 6},
      // elements
      {"<svg>\n  <use href='#a'/></svg>", 2, 3},
      {"<svg>\n  <cirlce r='1'/></svg>", 2, 3},
      {"<svg><circle/></svg>", 1, 6},
      {"<svg><circle r='0'/></svg>", 1, 17},
      {"<svg><circle r='-1'/></svg>", 1, 17},
      {"<svg><circle r='50%'/></svg>", 1, 19},
      {"<svg><circle r='2em'/></svg>", 1, 18},
      {"<svg><circle r='1 2'/></svg>", 1, 19},
      {"<svg><circle r='1e999'/></svg>", 1, 17},
      {"<svg><circle r='1e90'/></svg>", 1, 6},
      {"<svg><rect width='1'/></svg>", 1, 6},
      {"<svg><path/></svg>", 1, 6},
      {"<svg><circle id='a&b;' r='1'/></svg>", 1, 19},
      {"<svg><circle id='a&#7;' r='1'/></svg>", 1, 18},
      // transforms
      {"<svg><g transform='turn(3)'><circle r='1'/></g></svg>", 1, 20},
      {"<svg><g transform='scale 3'/></svg>", 1, 26},
      {"<svg><g transform='scale(3'/></svg>", 1, 27},
      {"<svg><g transform='scale(1,2,3)'/></svg>", 1, 30},
      {"<svg><g transform='matrix(1,2,3)'/></svg>", 1, 20},
      {"<svg><g transform='rotate(1,2)'/></svg>", 1, 20},
      {"<svg><g transform='translate(1) scale(0)'/></svg>", 1, 33},
      {"<svg><g transform='skewX(x)'/></svg>", 1, 26},
      // paths
      {"<svg><path d='L0 0'/></svg>", 1, 15},
      {"<svg><path d='M0 0L1 0\n  1 x'/></svg>", 2, 5},
      {"<svg><path d='M0 0L1,,2'/></svg>", 1, 22},
      {"<svg><path d='M0 0X'/></svg>", 1, 19},
      {"<svg><path d='M0 0L1'/></svg>", 1, 21},
      {"<svg><path d='M0 0A1 1 0 2 0 3 3'/></svg>", 1, 26},
      {"<svg><path d='M0 0L1 1 2 0'/></svg>", 1, 20},
      {"<svg><path d='M0 0A1e30 1e30 0 0 0 1e-9 0z'/></svg>", 1, 20},
      {"<svg><line x2='1'/></svg>", 1, 6},
      {"<svg><line x2='1'/><line x2='1'/><path d='M1 0L2 2'/></svg>", 1, 6},
      {"<svg><polygon points='0,0 1'/></svg>", 1, 28},
      {"<svg><polyline points='0,0 1,1 2,2'/></svg>", 1, 28},
      {"<svg><text>no walls</text></svg>", 0, 0},
      {"<svg><g display='none'><circle r='1'/></g></svg>", 0, 0},
  };
  for (const Fault& f : faults) {
    const InputError error = fault_of(f.svg);
    EXPECT_NE(error.problem(), "no fault") << f.svg;
    EXPECT_EQ(error.place().file, "d.svg") << f.svg << error.what();
    EXPECT_EQ(error.place().line, f.line) << f.svg << error.what();
    EXPECT_EQ(error.place().column, f.column) << f.svg << error.what();
    EXPECT_FALSE(error.expected().empty()) << f.svg << error.what();
  }
}

TEST(DrawingFaults, AreThoseOfTheTableToo) {
  const ScratchFolder folder;
  const auto place = [&](const std::string& drawing, const std::string& more = "") {
    std::ofstream(folder.file("d.svg")) << drawing;
    files::Value root = files::parse_document("[table]\nshape = \"svg\"\npath = \"d.svg\"\n" + more,
                                              folder.file("a.toml"));
    try {
      build_table(files::read_table(root));
    } catch (const InputError& error) {
      return error.place();
    }
    return Place{};
  };
  const std::string room = "<svg><rect width='9' height='9'/>\n";
  EXPECT_EQ(place(room + "\n<circle cx='9' cy='4' r='1'/></svg>").line, 3);  // crosses
  EXPECT_EQ(place(room + "<circle cx='20' r='1'/></svg>").line, 2);          // beside
  EXPECT_EQ(place(room + "<circle id='a' cx='2' cy='2' r='1'/>\n<circle id='a' cx='6' cy='2' "
                         "r='1'/></svg>")
                .line,
            3);
  EXPECT_EQ(place(room + "</svg>", "scale = 0\n").line, 4);
  EXPECT_EQ(place(room + "</svg>", "scale = \"sqrt(2)\"\n").line, 4);
  EXPECT_EQ(place(room + "</svg>", "scale = 1\nradius = 2\n").line, 5);
  EXPECT_EQ(place("<svg/>").file, folder.file("d.svg"));
  EXPECT_EQ(place(room + "<circle r='1'/>\n</svg>", "[[table.obstacle]]\n").line, 4);
}

// Nothing is expanded, so that a short text stays short.
TEST(DrawingFaults, EntitiesDoNotExplode) {
  std::string bomb = "<!DOCTYPE svg [<!ENTITY a0 \"0\">";
  for (int k = 1; k < 60; ++k)
    bomb += "<!ENTITY a" + std::to_string(k) + " \"&a" + std::to_string(k - 1) + ";&a" +
            std::to_string(k - 1) + ";\">";
  bomb += "]><svg>&a59;<circle id='&a59;' r='1'/></svg>";
  EXPECT_EQ(fault_of(bomb).place().line, 1);
  std::string deep;
  for (int k = 0; k < 100000; ++k) deep += "<g>";
  EXPECT_NE(fault_of("<svg>" + deep).problem(), "no fault");
  std::string turns = "<svg>", end;
  for (int k = 0; k < 250; ++k) {
    turns += "<g transform='rotate(1) skewX(1)'>";
    end += "</g>";
  }
  EXPECT_NE(fault_of(turns + "<circle r='1'/>" + end + "</svg>").problem(), "no fault");
  std::string digits(1000000, '1');
  EXPECT_NE(fault_of("<svg><circle r='" + digits + "'/></svg>").problem(), "no fault");
}

const std::string pieces[] = {"0",    "-1",   "1e99",       "1e-99", "<",      ">",   "/>",
                              "\"",   "'",    "&",          "&#0;",  "z",      "M",   "a1 1 0 01",
                              "\xff", "é",    "<g>",        "</g>",  "<!--",   "]]>", "scale(0)",
                              "e",    "1e-9", "rotate(45)", ",",     "<path ", "\n",  "<!DOCTYPE"};

/// A part of it comes once more, elsewhere.
std::string damaged(std::string text, Cases& cases) {
  return damaged(std::move(text), cases, pieces, [&](std::string& all, std::size_t at) {
    const std::string part = all.substr(cases.below(all.size()), cases.below(60));
    all.insert(at, part);
  });
}

TEST(DrawingFaults, DamagedDrawingsAreRefusedOrRead) {
  Cases cases(33);
  int refused = 0, read = 0;
  for (const char* name :
       {"inkscape", "illustrator", "figma", "pdf2svg", "stadium", "transforms"}) {
    std::ostringstream text;
    text << std::ifstream(CAROM_SOURCE "/tests/drawings/" + std::string(name) + ".svg").rdbuf();
    ASSERT_FALSE(text.str().empty());
    for (int k = 0; k < 1000; ++k) {
      const std::string svg = damaged(text.str(), cases);
      try {
        EXPECT_FALSE(files::loops_of_drawing(svg, "d.svg", 1).empty());
        ++read;
      } catch (const InputError& error) {
        ++refused;
        EXPECT_EQ(error.place().file, "d.svg") << svg << error.what();
      }
    }
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace carom::tests
