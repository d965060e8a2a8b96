// The regions of a table as flights see them: each a table of its own, with its own pieces.
#pragma once

#include <memory>
#include <vector>

#include "events/flight/piece_table.hpp"

namespace carom::events {

/// Made once; the worlds of all threads share it.
class Media {
 public:
  /// Keeps a reference to the table. `options` as of a PieceTable.
  Media(const Table& table, DecisionOptions options);
  /// Null for a table without regions.
  static std::shared_ptr<const Media> of(const Table& table, DecisionOptions options) {
    return table.regions.empty() ? nullptr : std::make_shared<const Media>(table, options);
  }

  const Table& table() const { return table_; }
  int size() const { return static_cast<int>(regions_.size()); }
  const Table& walls_of(int region) const {
    return *regions_[static_cast<std::size_t>(region)].walls;
  }
  const PieceTable& pieces_of(int region) const {
    return regions_[static_cast<std::size_t>(region)].pieces;
  }
  /// The number of a region's first wall in the table; of the outside 0.
  int first_wall(int region) const {
    return region < 0 ? 0 : table_.regions[static_cast<std::size_t>(region)].first;
  }
  /// The other side of a wall of the table that particles pass, or -1.
  int twin(int wall) const {
    const Wall& one = table_.walls[static_cast<std::size_t>(wall)];
    return one.closed ? -1 : one.twin;
  }

 private:
  struct Seen {
    std::unique_ptr<const Table> walls;  // the pieces refer to it
    PieceTable pieces;
  };
  const Table& table_;
  std::vector<Seen> regions_;
};

}  // namespace carom::events
