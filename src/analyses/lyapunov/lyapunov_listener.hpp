// Carries deviations along trajectories, and adds up how they grow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "carom/analyses/lyapunov.hpp"
#include "carom/engines/engine.hpp"
#include "engines/energy_watch.hpp"
#include "engines/ensemble_run.hpp"
#include "engines/record_of.hpp"

namespace carom::analyses {

/// The times at which lengths are taken, of all orbits the same.
class GrowthTimes {
 public:
  GrowthTimes(const GrowthSums&, const ConvergenceSums&);
  struct Mark {
    double time = 0.0;
    int block = -1;  ///< that ends there; the first one begins at the mark `opens`
    int look = -1;
    int point = -1;  ///< of the convergence
    bool opens = false;
  };
  const std::vector<Mark>& marks() const { return marks_; }
  std::vector<double> times() const;

 private:
  std::vector<Mark> marks_;
};

/// One thread's.
class LyapunovListener : public engines::EnsembleListener<LyapunovResult> {
 public:
  LyapunovListener(const System&, const GrowthTimes&, const GrowthSums& plan, double unit_length,
                   const Engine&, Thread&);

  void begin(const Trajectory&) override;
  void stretched(const Trajectory&, int particle, std::size_t number,
                 std::span<const double> logarithms, std::uint64_t hits) override;
  void end(const Trajectory&, const TrajectoryEnd&) override;

 private:
  struct Orbit;
  bool stays(const ParticleEnd&) const;
  void take(Orbit&, const GrowthTimes::Mark&, std::span<const double> logarithms,
            std::uint64_t hits) const;
  TrajectoryRecord record(const Trajectory&, const TrajectoryEnd&, std::size_t particle) const;

  /// What is known of a particle.
  struct Orbit {
    double pace = 1.0;    ///< mean flights in a unit of time
    double length = 0.0;  ///< ln|w| at the last mark of the window
    std::uint64_t hits_before = 0;
    double marked = 0.0, grown = 0.0, spread = 0.0;  ///< at the last mark: time, ln|w|, of both
    bool chaotic = false;
    OrbitGrowth growth;
    std::vector<double> frame, frame_before;  ///< growth in each block; logarithms at the last mark
    std::vector<double> convergence;          ///< ln|w| at each of its times
    DriftSums::Lengths lengths{}, volumes{};  ///< ln|w| and that of all that grow, at some looks
  };
  const std::vector<GrowthTimes::Mark>& marks_;
  const std::size_t blocks_;
  const double unit_length_;
  const bool together_;        ///< particles that interact are one orbit
  const bool from_walls_;      ///< starts stand for those of the map: what meets no wall is none
  const std::size_t growing_;  ///< exponents that are not negative or 0, of a spectrum
  const engines::RecordMaker record_of_;
  std::vector<std::vector<Orbit>> under_way_;   ///< by slot, then by particle
  const engines::EnergyWatch watch_;            ///< of a trajectory that has not begun
  std::vector<engines::EnergyWatch> energies_;  ///< by slot
};

}  // namespace carom::analyses
