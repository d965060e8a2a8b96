// The hits, samples, contacts and energies of a run as tables hold them: archives, Python,
// pictures.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "carom/base/fields.hpp"
#include "carom/events/event.hpp"
#include "carom/geometry/curve_frame.hpp"
#include "carom/system/system.hpp"
#include "carom/table/table.hpp"

namespace carom {

class World;

/// A reflection; velocities are those after it.
struct HitRow {
  std::int32_t particle = 0, wall = 0;
  double s = 0;           ///< arc length along the wall
  double v_parallel = 0;  ///< velocity along it, in the direction of s
  double t = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  ///< in the plane, unwrapped
  std::int64_t cell_first = 0, cell_second = 0;
  std::int32_t reflections = 1;  ///< n at a corner of angle pi/n, else 1
};

/// A particle at a time.
struct SampleRow {
  std::int32_t particle = 0;
  double t = 0;
  double x = 0, y = 0, vx = 0, vy = 0;  ///< in the plane, unwrapped
  std::int64_t cell_first = 0, cell_second = 0;
};

template <>
struct Fields<HitRow> {
  using R = HitRow;
  static constexpr std::tuple list{
      field("particle", "1", "Index of the particle", &R::particle),
      field("wall", "1", "Index into the attribute `names`", &R::wall),
      field("s", "length", "Arc length along the wall from its start", &R::s),
      field("v_parallel", "length/time",
            "Tangential velocity after the hit, positive in the direction of s", &R::v_parallel),
      field("t", "time", "Time of the hit", &R::t),
      field("x", "length", "Position, unwrapped", &R::x),
      field("y", "length", "Position, unwrapped", &R::y),
      field("vx", "length/time", "Velocity after the hit", &R::vx),
      field("vy", "length/time", "Velocity after the hit", &R::vy),
      field("cell_first", "1", "Cell of the lattice", &R::cell_first),
      field("cell_second", "1", "Cell of the lattice", &R::cell_second),
      field("reflections", "1", "Reflections counted: n at a corner of angle pi/n",
            &R::reflections)};
};

template <>
struct Fields<SampleRow> {
  using R = SampleRow;
  static constexpr std::tuple list{
      field("particle", "1", "Index of the particle", &R::particle),
      field("t", "time", "Time of the sample", &R::t),
      field("x", "length", "Position, unwrapped", &R::x),
      field("y", "length", "Position, unwrapped", &R::y),
      field("vx", "length/time", "Velocity", &R::vx),
      field("vy", "length/time", "Velocity", &R::vy),
      field("cell_first", "1", "Cell of the lattice", &R::cell_first),
      field("cell_second", "1", "Cell of the lattice", &R::cell_second)};
};

/// `frames`: those of frames_of(table) (analysis/section.hpp).
HitRow hit_row(const HitEvent&, const Table&, const std::vector<geometry::CurveFrame>& frames);
/// The same of many hits, some at a time: lengths along circles take less time together.
class HitRows {
 public:
  /// `table` is to live longer.
  explicit HitRows(const Table& table);
  void add(const HitEvent&);
  bool full() const { return rows_.size() == some; }
  /// Rows of what was added since the last call.
  std::vector<HitRow> take();

 private:
  static constexpr std::size_t some = 512;
  const Table& table_;
  std::vector<geometry::CurveFrame> frames_;
  std::vector<HitRow> rows_;  ///< without s
  std::vector<std::int32_t> walls_;
  std::vector<double> places_;
};

SampleRow sample_row(int particle, Time, const State&, const Table&);
/// The particles of a world that has not begun to move.
std::vector<SampleRow> start_rows(const World&, const Table&);

/// Two hard discs that touch. Centres are those in the plane, unwrapped; velocities those after the
/// contact.
struct ContactRow {
  std::int32_t first = 0, second = 0;  ///< first < second
  double t = 0;
  double first_x = 0, first_y = 0, second_x = 0, second_y = 0;
  double dx = 0, dy = 0;  ///< from the second's centre to the first's, of the copies that touch
  double first_vx = 0, first_vy = 0, second_vx = 0, second_vy = 0;
  double transfer = 0;  ///< momentum exchanged along the line of centres
};
template <>
struct Fields<ContactRow> {
  using R = ContactRow;
  static constexpr const char* copies =
      "From the second's centre to the first's, of the copies that touch";
  static constexpr std::tuple list{
      field("first", "1", "Index of one disc, the smaller", &R::first),
      field("second", "1", "Index of the other", &R::second),
      field("t", "time", "Time of the contact", &R::t),
      field("first_x", "length", "Centre of the first, unwrapped", &R::first_x),
      field("first_y", "length", "Centre of the first, unwrapped", &R::first_y),
      field("second_x", "length", "Centre of the second, unwrapped", &R::second_x),
      field("second_y", "length", "Centre of the second, unwrapped", &R::second_y),
      field("dx", "length", copies, &R::dx),
      field("dy", "length", copies, &R::dy),
      field("first_vx", "length/time", "Velocity of the first after the contact", &R::first_vx),
      field("first_vy", "length/time", "Velocity of the first after the contact", &R::first_vy),
      field("second_vx", "length/time", "Velocity of the second after the contact", &R::second_vx),
      field("second_vy", "length/time", "Velocity of the second after the contact", &R::second_vy),
      field("transfer", "momentum", "Momentum exchanged along the line of centres", &R::transfer)};
};

ContactRow contact_row(const ContactEvent&, const Table&);

/// Sums over the particles that are there at a time (events/energy.hpp).
struct EnergyRow {
  double t = 0;
  double kinetic = 0, external = 0, pair = 0, total = 0;
  double px = 0, py = 0, angular_momentum = 0;
};

template <>
struct Fields<EnergyRow> {
  using R = EnergyRow;
  static constexpr std::tuple list{
      field("t", "time", "Time of the sample", &R::t),
      field("kinetic", "energy", "Sum of m v^2 / 2", &R::kinetic),
      field("external", "energy", "Sum of the external potentials", &R::external),
      field("pair", "energy", "Sum of the interactions, each pair once", &R::pair),
      field("total", "energy", "Their sum", &R::total),
      field("px", "momentum", "Sum of m v", &R::px),
      field("py", "momentum", "Sum of m v", &R::py),
      field("angular_momentum", "angular momentum",
            "Sum of m (x cross v + omega r^2 / 2), about the origin", &R::angular_momentum)};
};

/// Makes a row of the samples of each time. Refers to the system.
class EnergyRows {
 public:
  explicit EnergyRows(const System& system) : system_(system) {}
  /// Asked while energies are summed, which takes seconds for thousands of particles. True: stop.
  void listen(std::function<bool()> interrupted) { interrupted_ = std::move(interrupted); }
  /// Where forces act or hard discs touch; elsewhere there are no rows.
  bool wanted() const;
  void sample(int particle, const State&);
  /// Sets the row of the samples since the last one, if there were any. False: the sum over all
  /// pairs was interrupted, and there is no row.
  bool sampled(Time, std::optional<EnergyRow>& row);

 private:
  const System& system_;
  std::vector<Particle> particles_;
  std::vector<State> states_;
  std::function<bool()> interrupted_;
};

}  // namespace carom
