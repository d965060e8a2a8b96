// Which wall a flight meets first: the choosing driver of the event loop.
//
// Decisions are taken in double precision with derived bounds; where one of them cannot tell, the
// whole flight is decided again in exact arithmetic. Numbers (kappa, time, point) come from the
// same formulas in double precision either way, so that bounds never show in a result.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "events/flight/crossing.hpp"
#include "events/flight/flight.hpp"
#include "events/flight/piece_table.hpp"

namespace carom::events {

/// Finds the first hits of flights in one table. It writes to its own memory while it does, so each
/// thread needs one of its own; they share the table.
class HitFinder {
 public:
  explicit HitFinder(const PieceTable& pieces);
  /// Prepares the table for this finder alone.
  explicit HitFinder(const Table& table, DecisionOptions options = {})
      : HitFinder(PieceTable(table, options)) {}

  const PieceTable& pieces() const { return t_; }

  void next(const Flight& flight, Ahead& ahead, DecisionCounts& counts);
  Ahead next(const Flight& flight, DecisionCounts& counts) {
    Ahead ahead;
    next(flight, ahead, counts);
    return ahead;
  }
  /// The first half of this: in a convex table with nothing in it, where the filter can tell.
  bool next_in_convex(const Flight& flight, Ahead& ahead, DecisionCounts& counts) const;
  /// The same without field, off the joints of a table whose enclosure meets_four; without kappa,
  /// which of lines only holes ask for.
  bool next_in_four(const Flight& flight, Ahead& ahead, DecisionCounts& counts) const;
  /// The other half.
  void next_in_any(const Flight& flight, Ahead& ahead, DecisionCounts& counts);
  /// That where discs stand in a lattice's cell and touch none of its edges: a straight flight is
  /// taken over some edges at once.
  void next_over_edges(Flight& flight, Ahead& ahead, DecisionCounts& counts);
  /// The first half of this, where the filter can tell; else the flight is over some edges.
  bool over_edges(Flight& flight, Ahead& ahead, DecisionCounts& counts) const;

 private:
  /// Sees the walls from the flight's start, in its cell. Number by number: a 16-byte copy of two
  /// numbers that were just stored one by one would wait for them.
  void look_from(const Flight& f) {
    Origin& own = origins_[0];
    own.point.x = f.start.x;
    own.point.y = f.start.y;
    own.scale.delta = f.start_error;
    own.scale.speed_1 = std::fabs(f.velocity.x) + std::fabs(f.velocity.y);
    own.scale.omega = std::fabs(f.omega);
    own.scale.inflation = t_.options.filter_inflation;
    if (t_.cells && (f.cell.first | f.cell.second) != 0) own = t_.origin_of(f, 0);
  }
  /// The same from the cells of all offsets.
  void look_from_all(const Flight& flight);

  // By double precision: false where a bound cannot tell.
  template <bool larmor, bool cells>
  bool filtered(const Flight& flight, Ahead& ahead) {
    double unused = 0.0;
    return filtered_of<larmor, cells, false>(flight, ahead, {}, unused);
  }
  /// The same among some pieces (`listed`), with the error of kappa.
  template <bool larmor, bool cells, bool listed>
  bool filtered_of(const Flight& flight, Ahead& ahead, std::span<const int> list, double& error);
  template <bool larmor, bool cells>
  bool see_all_joints(const Flight& flight, const Origin& single);
  template <bool larmor, bool cells>
  bool see_joints(const Flight& flight, std::span<const int> list);
  void next_of_all(const Flight& flight, Ahead& ahead, DecisionCounts& counts);
  Ahead exact_next(const Flight& flight, const std::vector<int>& pieces) const;

  // Convex tables (enclosed_hit.hpp and .cpp).
  bool filtered_among_discs(const Flight& flight, Ahead& ahead) const;
  bool line_in_enclosure(const Flight& flight, Ahead& ahead) const;
  bool line_to(const Flight& flight, int wall, Ahead& ahead) const;
  double kappa_of_line(const Flight& flight, int wall) const;
  bool circle_in_enclosure(const Flight& flight, Ahead& ahead) const;
  Sign meets_one_disc(const Flight& flight, const Origin& origin, int& met, Quotient& at) const;
  int exit_of_enclosure(const Flight& flight, const Origin& origin) const;
  static bool put(int piece, Ahead::Kind kind, const Quotient& at, Ahead& ahead);
  static bool put(int wall, double duration, Ahead& ahead);
  void next_by_signs(const Flight& flight, Ahead& ahead, DecisionCounts& counts);

  // Tables of many walls (grid_hit.cpp).
  void next_in_grid(const Flight& flight, Ahead& ahead, DecisionCounts& counts);
  template <bool larmor, bool cells>
  bool filtered_in_grid(const Flight& flight, Ahead& ahead);
  bool filtered_among_many(const Flight& flight, Ahead& ahead);
  template <bool larmor>
  bool filtered_in_tree(const Flight& flight, Ahead& ahead);
  /// The same where one piece is all that the flight may leave through, and its side surely rises
  /// through zero along it. False: `filtered_of` is to tell.
  template <bool larmor>
  bool filtered_alone(const Flight& flight, int piece, Ahead& ahead) const;
  /// The first disc of those that a line is certain to enter from outside.
  struct FirstDisc {
    int piece = -1;
    double time = 0.0, unit = 1.0, kappa = 0.0, error = 0.0;
  };
  Sign meets_disc(const Flight& flight, const PieceTable::Near& two, std::size_t which,
                  FirstDisc& first);
  /// What a flight asks two pieces of a grid's list.
  struct NearFlight;
  template <bool larmor>
  NearFlight near_flight(const Flight& flight) const;
  template <bool larmor>
  static unsigned not_missed(const NearFlight& flight, const PieceTable::Near& two);
  /// The origin of an offset but the first, where a flight among many walls may not have needed it
  /// yet.
  const Origin& seen_from(const Flight& f, int offset) {
    const auto k = static_cast<std::size_t>(offset);
    if (seen_offsets_[k] != flights_) {
      seen_offsets_[k] = flights_;
      origins_[k] = t_.origin_of(f, offset);
    }
    return origins_[k];
  }
  const std::vector<int>& pieces_on_way(const Flight& flight);
  template <class Visit, class Passed>
  void follow(const Flight& flight, const Visit& visit, const Passed& passed) const;

  const PieceTable t_;
  std::vector<Origin> origins_;              // one an offset
  std::vector<unsigned char> left_;          // is the joint on the left of the flight?
  std::vector<std::uint32_t> seen_;          // a piece: the last flight that came near it
  std::vector<std::uint32_t> seen_offsets_;  // an offset: the last flight that asked for its origin
  std::uint32_t flights_ = 0;
  std::vector<int> list_;  // pieces on the way of a flight
  // Where the sides of the joints tell the exit (PieceTable::signs), for each piece and set of
  // joints on the right of a flight from there: the exit, once one has shown it.
  static constexpr unsigned char unknown_exit = 255;
  std::vector<unsigned char> exits_;
};

}  // namespace carom::events

#include "events/flight/enclosed_hit.hpp"  // the inline functions of convex tables
