// Exact ties of straight flights: an orbit that runs exactly into a corner, touches a disc, meets
// the end of a hole. No precision tells them. Where start, direction and table are rational numbers
// as written, rational arithmetic does.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "carom/certify/certified_orbit.hpp"
#include "certify/flight/scene.hpp"
#include "certify/wall/rational_table.hpp"

namespace carom::certify {

/// A question that balls could not decide at an event.
struct Doubt {
  enum Kind : unsigned char {
    choice,    ///< which of `first` and `second` is met first; without a second, whether `first` is
               ///< met
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
  std::vector<Copy>
      joint{};  ///< the walls that are met there: that which ends and that which begins
  std::optional<WallEnd> at{};  ///< balls have to prove that no other wall comes before this
  int hole = -1;                ///< in Table::holes, of an end of a hole
  int beside =
      -1;  ///< of a reflection: the segment that is not met when the flight leaves the joint
  bool goes_on() const { return kind != corner && kind != along_wall; }
};

/// Follows an orbit in rational numbers over the walls that balls have proven.
class TieFinder {
 public:
  TieFinder(const ExactSystem& system, const CertifiedTask& task) : system_(system), task_(task) {}
  TieFinder(const TieFinder&) = delete;
  TieFinder& operator=(const TieFinder&) = delete;
  /// The tie at the event after the walls `path` were met (each call with a longer path of the same
  /// orbit). Nothing where there is none, in a field, and where a number is not rational or longer
  /// than 65536 bits.
  std::optional<Tie> find(const std::vector<Copy>& path, const Doubt&);

 private:
  using Vector = VectorOf<Rational>;
  using Wall = WallOf<Rational>;
  struct Flight {
    Vector position, velocity;
    Rational time;  ///< in units of |direction as written|/speed
    int standing = -1;
  };
  // All of these throw NotRational.
  void prepare();
  void fly_to(Flight&, const Copy&) const;
  std::optional<Tie> tie(const Doubt&) const;
  std::optional<Tie> with_wall(const Copy&) const;
  std::optional<Tie> touching(const Wall&, const Vector& P, const Copy&, bool standing) const;
  std::optional<Tie> at_joint(const Vector& joint, const Copy& met) const;
  bool opens_at(int wall, bool at_its_end) const;
  std::optional<Tie> with_hole(const Flight&, int hole) const;
  bool is_at(const Flight&, const HoleSpec&, int side) const;
  std::optional<Tie> with_last_time(const Flight&) const;

  const Wall& wall(int index) const { return table_.walls[static_cast<std::size_t>(index)]; }
  std::string name(int index) const {
    return "'" + system_.table->walls[static_cast<std::size_t>(index)].name + "'";
  }
  Vector seen(const Vector& P, const Copy& copy) const {
    return copy.cell == geometry::Cell{} ? P : P - table_.lattice->at(copy.cell);
  }

  const ExactSystem& system_;
  const CertifiedTask& task_;
  TableOf<Rational> table_;
  MotionOf<Rational> motion_;
  Flight now_;
  std::size_t followed_ = 0;
  bool prepared_ = false, hopeless_ = false;
};

/// Ties that an orbit has gone through, by the number of the event.
struct KnownTies {
  std::map<std::uint64_t, int> holes;                    ///< the hole that is left through, or -1
  std::map<std::uint64_t, std::vector<Copy>> passed_by;  ///< walls that are touched and not hit
  struct Joint {
    Copy hit;              ///< the wall that is hit there
    std::vector<Copy> of;  ///< Tie::joint, or nothing where the particle is in the joint already
    WallEnd at{};
    std::string dead_end{};  ///< why the orbit ends there, if it does
  };
  std::map<std::uint64_t, Joint> joints;
  std::uint64_t at_last_time = 0;
};

}  // namespace carom::certify
