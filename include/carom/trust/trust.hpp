// How far an orbit in double precision can be trusted: the true orbit is followed beside it in
// twice the digits. docs/physics/tangent-map.md has the estimate and what it is worth.
#pragma once

#include <cstdint>
#include <memory>

#include "carom/events/observer.hpp"
#include "carom/table/table.hpp"

namespace carom::trust {
struct WrittenSystem;
}  // namespace carom::trust

namespace carom {

/// A system as it was written, in twice the digits of a double (written_system() of io/).

/// The true state after an event less the computed one, each at its own hit.
struct OrbitError {
  geometry::Vector position, velocity;
  double time = 0.0;
};

/// What is known of one particle's errors; a run goes on from it.
struct Trust {
  bool known = false;      ///< false: nothing is estimated (forces, hard discs)
  bool open = false;       ///< no error has become too large yet
  std::uint64_t hits = 0;  ///< reflections before the first whose error is too large
  Time time;               ///< of the last of these; while open: of the last event
  OrbitError error;        ///< while open: of the state after the last event
};

/// The length that tolerances are measured by: the longer side of the box around the walls, on a
/// lattice the longer of its vectors.
double size_of(const Table&);

/// Watches free particles. An orbit is trusted up to a hit if the errors of its point and of its
/// time times the speed stay below the tolerance times the table's size, that of its direction
/// below the tolerance, all with a margin, and the engine finds the same walls beyond the error.
class TrustRecorder : public Observer {
 public:
  static constexpr double usual_tolerance = 1e-3;
  /// Errors are taken this many times as large.
  static constexpr double margin = 1.05;

  /// Keeps a reference to the table, which must live as long. `written`: what the table's doubles
  /// were rounded from, and the first particle's start; nothing: they are what is meant.
  explicit TrustRecorder(const Table&, double tolerance = usual_tolerance,
                         std::shared_ptr<const trust::WrittenSystem> written = nullptr);
  ~TrustRecorder() override;

  /// Follows the world's next particle from its state, which has made `hits` hits; `before`: what
  /// was known when an earlier part of the run ended there.
  void follow(const Particle&, const State&, std::uint64_t hits, const Trust* before = nullptr);
  void hit(const HitEvent&) override;
  void end(const EndEvent&) override;
  const Trust& trust(int particle) const;
  /// What is known at the end of a run, a free flight after the state of the last event.
  Trust at_end(const Particle&, const State&, const Trust&, Time end) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace carom
