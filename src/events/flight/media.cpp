#include "events/flight/media.hpp"

#include <utility>

namespace carom::events {

Media::Media(const Table& table, DecisionOptions options) : table_(table) {
  for (int r = 0; r < static_cast<int>(table.regions.size()); ++r) {
    auto walls = std::make_unique<const Table>(seen_from(table, r));
    PieceTable pieces(*walls, options);
    regions_.push_back({std::move(walls), std::move(pieces)});
  }
}

}  // namespace carom::events
