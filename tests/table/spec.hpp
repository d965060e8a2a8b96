// Specifications of tables for tests.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "carom/table/table.hpp"

namespace carom::tests {

inline ExactNumber exact(const std::string& text, const std::string& key = "") {
  return ExactNumber(text, Place{"test.toml", 7, 3, key});
}

inline ExactPoint at(const std::string& x, const std::string& y) { return {exact(x), exact(y)}; }

inline TableSpec shape(const std::string& name,
                       const std::map<std::string, std::string>& numbers = {}) {
  TableSpec spec;
  spec.shape = name;
  spec.place = Place{"test.toml", 1, 1, "table"};
  spec.shape_place = Place{"test.toml", 2, 1, "table.shape"};
  for (const auto& [key, text] : numbers) spec.numbers[key] = exact(text, "table." + key);
  return spec;
}

inline TableSpec with_hole(TableSpec spec, const std::string& wall, const std::string& center,
                           const std::string& width, const std::string& name = "") {
  HoleSpec hole;
  hole.wall = wall;
  const std::string path = "table.hole[" + std::to_string(spec.holes.size()) + "]";
  hole.center = exact(center, path + ".center");
  hole.width = exact(width, path + ".width");
  hole.name = name;
  hole.place = Place{"test.toml", 20, 1, path};
  hole.wall_place = Place{"test.toml", 21, 8, path + ".wall"};
  spec.holes.push_back(hole);
  return spec;
}

inline PieceSpec line_to(const std::string& x, const std::string& y, const std::string& name = "") {
  PieceSpec piece;
  piece.to = at(x, y);
  piece.name = name;
  piece.place = Place{"test.toml", 12, 5, "table.loop[0].pieces"};
  return piece;
}

inline PieceSpec arc_to(ExactPoint via, ExactPoint to) {
  PieceSpec piece = line_to("0", "0");
  piece.kind = PieceSpec::Kind::arc;
  piece.via = std::move(via);
  piece.to = std::move(to);
  return piece;
}

inline PieceSpec ellipse_to(ExactPoint via, ExactPoint to, const std::string& ratio,
                            const std::string& angle) {
  PieceSpec piece = arc_to(std::move(via), std::move(to));
  piece.kind = PieceSpec::Kind::ellipse;
  piece.ratio = exact(ratio);
  piece.angle = exact(angle);
  return piece;
}

inline LoopSpec loop(ExactPoint start, std::vector<PieceSpec> pieces) {
  LoopSpec spec;
  spec.start = std::move(start);
  spec.pieces = std::move(pieces);
  spec.place = Place{"test.toml", 10, 1, "table.loop[0]"};
  return spec;
}

inline std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  for (const Wall& wall : table.walls) names.push_back(wall.name);
  return names;
}

/// The InputError that building the table gives, or one with the problem "no fault".
inline InputError fault(const TableSpec& spec) {
  try {
    build_table(spec);
  } catch (const InputError& error) {
    return error;
  }
  return InputError("no fault");
}
/// The key that is to blame, "" where there is no fault.
inline std::string blamed(const TableSpec& spec) { return fault(spec).place().key; }
inline bool is_legal(const TableSpec& spec) { return fault(spec).problem() == "no fault"; }

}  // namespace carom::tests
