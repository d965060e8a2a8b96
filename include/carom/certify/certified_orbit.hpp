// Orbits with guaranteed digits: every number is enclosed by ball arithmetic, and the precision is
// chosen by the program (docs/physics/certified-orbits.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "carom/certify/exact_system.hpp"
#include "carom/geometry/lattice.hpp"

namespace carom {

namespace certify {
class FollowedOrbit;
}

/// A number together with what its error cannot exceed.
class CertifiedNumber {
 public:
  struct Enclosure;  ///< a ball of any precision
  CertifiedNumber() = default;
  explicit CertifiedNumber(std::shared_ptr<const Enclosure> value) : value_(std::move(value)) {}
  /// What text(digits) has written: within 10^-digits of these decimals. Throws InputError, at that
  /// place, for anything else.
  static CertifiedNumber of_text(const std::string& decimals, int digits, const Place& = {});

  /// With `digits` decimals, the last one rounded.
  std::string text(int digits) const;
  /// The double nearest to the middle of the enclosure.
  double to_double() const;
  /// log2 of the enclosure's radius.
  double log2_error() const;
  const Enclosure& enclosure() const { return *value_; }
  bool has_value() const { return value_ != nullptr; }

 private:
  std::shared_ptr<const Enclosure> value_;
};

/// A state with guaranteed digits. The position is in the plane, unwrapped.
struct CertifiedState {
  CertifiedNumber t, x, y, vx, vy;
};

/// A reflection: the state after it.
struct CertifiedHit : CertifiedState {
  std::uint64_t number = 0;  ///< counted from 1
  int wall = -1;
  geometry::Cell cell;  ///< of the wall's copy
};

/// How a certified orbit ended.
enum class CertifiedFate : unsigned char {
  completed,
  escaped,
  unbounded,  ///< no wall follows
  pinned,     ///< a Larmor circle that meets no wall
  singular,
  undecided,
  interrupted
};
const char* name_of(CertifiedFate);

/// The end of an orbit: its fate, and the state after the last event.
struct CertifiedEnd : CertifiedState {
  CertifiedFate fate = CertifiedFate::completed;
  std::uint64_t collisions = 0;
  int wall = -1;        ///< of the last hit
  geometry::Cell cell;  ///< of the last hit, or of the hole it left through
  int hole = -1;
  std::string reason;  ///< of singular and undecided ones
  std::vector<std::string>
      ties;  ///< exact coincidences that the orbit went through, decided in rational numbers
};

/// What an orbit is asked for.
struct CertifiedTask {
  std::uint64_t collisions = 0;      ///< 0: no cap
  std::optional<ExactNumber> t_max;  ///< last time
  int digits = 20;                   ///< absolute error below 10^-digits in t, x, y, vx, vy
  long most_bits = 4'000'000;        ///< the precision beyond which an orbit is given up
  long most_bits_a_doubt = 1 << 14;  ///< beyond what the orbit loses, spent on deciding one event
};

inline constexpr std::uint64_t most_digits = 1'000'000;
/// Throws InputError, at that place, unless so many digits can be asked for: at least one, at most
/// `most_digits`, and fewer where the numbers of a table of many walls would take more than 4 GB.
void check_digits(std::uint64_t digits, const Table&, const Place& = {});

/// What it took.
struct CertifiedEffort {
  long bits = 0;  ///< precision of the last attempt
  int attempts = 0;
  bool rescaled = false;  ///< the start's velocity had not the speed: it was taken as a direction
  double tangent_bits =
      0;  ///< log2 of how much the tangent map stretched: bits that the orbit lost
};

/// A sequence of certified hits. Whenever the precision does not suffice, the orbit is run again
/// from its exact start with more bits; hits that were given out stay true.
class CertifiedOrbit {
 public:
  /// Throws InputError for what has no certified form. `interrupted`, if set, is asked at every hit
  /// of the orbit and of the look ahead; then the orbit ends with the last hit that was given out.
  CertifiedOrbit(const ExactSystem&, const CertifiedTask&, std::function<bool()> interrupted = {});
  ~CertifiedOrbit();
  CertifiedOrbit(CertifiedOrbit&&) noexcept;

  /// The next hit, or nothing when the orbit has ended.
  std::optional<CertifiedHit> next();
  /// Runs to the end.
  const CertifiedEnd& finish();
  const CertifiedEnd& end_state() const;  ///< once next() has returned nothing
  const CertifiedEffort& effort() const;

  /// An input iterator: `for (const CertifiedHit& hit : orbit)`; std::ranges views take it too.
  class iterator {
   public:
    using value_type = CertifiedHit;
    using difference_type = std::ptrdiff_t;
    using iterator_concept = std::input_iterator_tag;
    iterator() = default;
    explicit iterator(CertifiedOrbit* orbit) : orbit_(orbit) { ++*this; }
    const CertifiedHit& operator*() const { return *hit_; }
    const CertifiedHit* operator->() const { return &*hit_; }
    iterator& operator++() {
      hit_ = orbit_->next();
      return *this;
    }
    void operator++(int) { ++*this; }
    friend bool operator==(const iterator& i, std::default_sentinel_t) { return !i.hit_; }

   private:
    CertifiedOrbit* orbit_ = nullptr;
    std::optional<CertifiedHit> hit_;
  };
  iterator begin() { return iterator(this); }
  std::default_sentinel_t end() const { return {}; }

 private:
  std::unique_ptr<certify::FollowedOrbit> implementation_;
};

/// The first `collisions` hits of a system as its file gives it (LoadedSystem::exact, whose start
/// is a point), each with `digits` guaranteed decimals; fewer where the orbit ends before:
///   for (const CertifiedHit& hit : certified_orbit(load_system("siam-photon").exact, 1000, 20)) …
CertifiedOrbit certified_orbit(const ExactSystem&, std::uint64_t collisions, int digits);
/// The same on a table, with speed 1 and without field.
CertifiedOrbit certified_orbit(const TableSpec& table, const ExactStart& start,
                               std::uint64_t collisions, int digits);

}  // namespace carom
