// How many particles of an ensemble ended in which way.
#pragma once

#include <cstdint>

#include "carom/base/fields.hpp"
#include "carom/motion/state.hpp"
#include "carom/system/system.hpp"

namespace carom {

/// (1) all() == survived + escaped + singular + unresolved + lost: each particle is in one of them
/// (2) pinned and capped ones are among those that survived, unbounded ones among the escaped
struct FateCounts {
  std::uint64_t survived = 0;   ///< still there at the end
  std::uint64_t pinned = 0;     ///< of those, on a cyclotron orbit that never hits
  std::uint64_t capped = 0;     ///< of those, ended by the cap on hits
  std::uint64_t escaped = 0;    ///< through a hole, or to infinity
  std::uint64_t unbounded = 0;  ///< of those, to infinity: no wall follows any more
  std::uint64_t singular = 0, unresolved = 0, lost = 0;

  void count(Fate);
  void add_fates(const FateCounts&);
  /// Particles that were counted.
  std::uint64_t all() const { return survived + escaped + singular + unresolved + lost; }
  /// Those that were followed until the last time: survivors that no cap ended.
  std::uint64_t until_last_time() const { return survived - capped; }
};

template <>
struct Fields<FateCounts> {
  using C = FateCounts;
  static constexpr std::tuple list{
      field("survived", "1", "Still inside at the end", &C::survived),
      field("pinned", "1", "Survivors on a cyclotron orbit that never hits", &C::pinned),
      field("capped", "1", "Survivors ended by the cap on hits", &C::capped),
      field("escaped", "1", "Left through a hole, or to infinity", &C::escaped),
      field("unbounded", "1", "Escaped to infinity: no wall follows", &C::unbounded),
      field("singular", "1", "Ended where no continuation is defined", &C::singular),
      field("unresolved", "1", "Ended where integration could not follow", &C::unresolved),
      field("lost", "1", "Internal errors: always 0", &C::lost)};
};

inline void FateCounts::count(Fate fate) {
  switch (fate) {
    case Fate::survived:
      ++survived;
      return;
    case Fate::pinned:
      ++pinned;
      ++survived;
      return;
    case Fate::capped:
      ++capped;
      ++survived;
      return;
    case Fate::escaped:
      ++escaped;
      return;
    case Fate::singular:
      ++singular;
      return;
    case Fate::unbounded:
      ++unbounded;
      ++escaped;
      return;
    case Fate::unresolved:
      ++unresolved;
      return;
    case Fate::lost:
      ++lost;
      return;
  }
}

inline void FateCounts::add_fates(const FateCounts& other) { join_fields(*this, other); }

/// The fates, and what happened until then.
struct EndCounts : FateCounts {
  /// Trajectories; where particles are counted one by one, the particles of all of them.
  std::uint64_t trajectories = 0;
  std::uint64_t collisions = 0;
  std::uint64_t contacts = 0;  ///< of hard discs, each pair once

  void add_end(Fate fate, std::uint64_t hits) {
    ++trajectories;
    count(fate);
    collisions += hits;
  }
  void add_ends(const EndCounts& other);
};

/// Besides the trajectories and their fates.
template <>
struct Fields<EndCounts> {
  using C = EndCounts;
  static constexpr std::tuple list{
      field("collisions", "1", "Reflections of all particles", &C::collisions),
      reported_if(&System::of_discs,
                  field("contacts", "1", "Contacts of hard discs, each pair once", &C::contacts))};
};

inline void EndCounts::add_ends(const EndCounts& other) {
  add_fates(other);
  trajectories += other.trajectories;
  join_fields(*this, other);
}

}  // namespace carom
