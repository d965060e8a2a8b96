// Exact ties: an orbit that runs exactly into a corner, touches a disc, meets the end of a hole. No precision
// tells them; where the numbers are rational, or of one square root, algebra does.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carom/certify/certified_orbit.hpp"
#include "certify/scene.hpp"

namespace carom::certify {

/// What balls could not tell at an event.
struct Doubt {
  enum Kind : unsigned char {
    choice,    ///< which of `first` and `second` is met first; without a second, whether `first` is met
    hole,      ///< on which side of an end of `hole` the wall `first` is met
    last_time  ///< whether `first` is met before the last time
  } kind = choice;
  Copy first, second;
  int hole_index = -1;
};

/// An end of a wall: where it stops, or where it begins.
struct WallEnd {
  Copy copy;
  bool last = true;
};

struct Tie {
  enum Kind : unsigned char {
    corner,      ///< into a joint at which reflection has no limit
    reflection,  ///< into a joint at which it has: `walls` are hit one after the other
    tangency,    ///< touches walls.front() from the domain: no hit
    along_wall,  ///< moves along a wall, or starts tangent to the one it lies on
    hole_start,  ///< belongs to the hole
    hole_end,    ///< does not
    last_time    ///< a hit at the last time counts
  } kind = corner;
  std::string text;
  std::vector<Copy> walls{};
  std::vector<Copy> joint{};  ///< the walls that are met there: that which ends and that which begins
  std::optional<WallEnd> at{};  ///< balls have to prove that no other wall comes before this
  int hole = -1;              ///< in Table::holes, of an end of a hole
  int beside = -1;  ///< of a reflection: the segment that is not met when the flight leaves the joint
  bool goes_on() const { return kind != corner && kind != along_wall; }
};

/// Follows an orbit in exact numbers over the walls that balls have proven.
class TieFinder {
 public:
  TieFinder(const ExactSystem&, const CertifiedTask&);
  ~TieFinder();
  TieFinder(const TieFinder&) = delete;
  TieFinder& operator=(const TieFinder&) = delete;
  /// The tie at the event after the walls `path` were met (each call with a longer path of the same orbit),
  /// or nothing where algebra finds none: because there is none, or numbers are not of the form or too long.
  std::optional<Tie> find(const std::vector<Copy>& path, const Doubt&);
  /// Why exact numbers could not follow to the last event that was asked for; "" where they could.
  const std::string& obstacle() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Ties that an orbit has gone through, by the number of the event.
struct KnownTies {
  std::map<std::uint64_t, int> holes;                    ///< the hole that is left through, or -1
  std::map<std::uint64_t, std::vector<Copy>> passed_by;  ///< walls that are touched and not hit
  struct Joint {
    Copy hit;               ///< the wall that is hit there
    std::vector<Copy> of;   ///< Tie::joint, or nothing where the particle is in the joint already
    WallEnd at{};
    std::string dead_end{};  ///< why the orbit ends there, if it does
  };
  std::map<std::uint64_t, Joint> joints;
  std::uint64_t at_last_time = 0;
};

}  // namespace carom::certify
