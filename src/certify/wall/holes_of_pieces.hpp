// Holes as they were written, as arc lengths of the written curves.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "carom/certify/exact_system.hpp"
#include "certify/wall/hole.hpp"
#include "certify/wall/piece.hpp"

namespace carom::certify {

/// The length of a piece from its start on, as polynomials on parts of it with their errors.
class ArcLength {
 public:
  explicit ArcLength(const Piece&);
  /// Without bounds beyond the ends.
  Ball to(const Ball& t) const;

 private:
  struct Part {
    Ball range, middle;
    Series length;  ///< from the middle to a parameter, by its distance from there
    Ball before;    ///< what to add
  };
  void add(double from, double to, int depth);

  const Piece& piece_;
  Ball sum_ = 0;
  std::vector<Part> parts_;
};

/// To the present precision.
class HolesOfPieces {
 public:
  HolesOfPieces(const ExactSystem&, const Pieces&);
  /// The hole that a point lies in: its start belongs to it, its end does not.
  Passage passage(const Pieces::Spot&) const;

 private:
  /// One wall or more of a piece.
  struct Stretch {
    Ball start;   ///< length along the piece where it begins
    Ball before;  ///< along all walls of the hole
    Ball length;
    bool whole;  ///< all of the piece
  };
  struct Opening {
    int hole;
    Ball from, to, length;
    bool closed;  ///< Do its walls end where they begin?
    std::map<std::size_t, Stretch> stretches;
  };

  const Pieces& pieces_;
  std::map<std::size_t, ArcLength> lengths_;
  std::vector<Opening> openings_;
};

}  // namespace carom::certify
