#include "analyses/compare/orders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "carom/base/elementary.hpp"

namespace carom::analyses {

using geometry::Vector;

namespace {

/// Displacements in units of the way in a step, and of the velocity: with central differences of
/// order 6, rounding and what they leave out are about as large, 1e-13.
constexpr double displacement_of_map = 0x1p-8;
/// Displacements that are combined to pairs: four of them span the phase space of one particle.
constexpr int vectors = 4;
/// Weights of the differences at 1, 2 and 3 displacements, times 60: order 6.
constexpr std::array<double, 3> weights{45.0, -9.0, 1.0};
/// Truncation falls by 2^6 when displacements are halved, so that the difference of both results
/// is all of the larger one's error, and rounding is seen as well.
constexpr double finer = 0.5;

using Displacement = std::vector<PlaneState>;  // or a derivative; one entry a particle

/// Numbers without relation between -1 and 1.
double entry(int vector, std::size_t particle, int component) {
  const double k = static_cast<double>(vector), i = static_cast<double>(particle);
  return elementary::cos(1.0 + 2.399963 * k + 5.083204 * i +
                         static_cast<double>(component) * (1.7 + 0.9 * k));
}

class StepMap {
 public:
  StepMap(const Runs& runs, const Dynamics& dynamics, double step)
      : table_(*runs.system().table), step_(step), world_(table_, dynamics) {}

  void start_from(std::vector<Particle> particles, std::vector<State> states) {
    particles_ = std::move(particles);
    states_ = std::move(states);
  }

  /// Where the states lead that are displaced by a share of `by`. Nothing where a wall is met.
  std::optional<Displacement> image(const Displacement& by, double share) {
    world_.clear();
    try {
      for (std::size_t i = 0; i < states_.size(); ++i) {
        State s = states_[i];
        s.position = s.position + share * by[i].position;
        s.velocity = s.velocity + share * by[i].velocity;
        Particle particle = particles_[i];
        particle.speed = length(s.velocity);
        world_.add(particle, s);
      }
    } catch (const std::invalid_argument&) {  // beyond a wall
      return {};
    }
    world_.run_until(step_);
    Displacement image;
    for (int i = 0; i < world_.size(); ++i) {
      if (world_.finished(i) || world_.hits(i) > 0) return {};
      image.push_back(in_the_plane(table_, world_.state_at(i, step_)));
    }
    return image;
  }

  std::optional<Displacement> derivative(const Displacement& along, double share) {
    Displacement sum(states_.size());
    for (int k = 1; k <= 3; ++k) {
      const auto ahead = image(along, k * share), behind = image(along, -k * share);
      if (!ahead || !behind) return {};
      const double weight = weights[static_cast<std::size_t>(k - 1)] / (60.0 * share);
      for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i].position = sum[i].position + weight * ((*ahead)[i].position - (*behind)[i].position);
        sum[i].velocity = sum[i].velocity + weight * ((*ahead)[i].velocity - (*behind)[i].velocity);
      }
    }
    return sum;
  }

  double form(const Displacement& a, const Displacement& b) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
      sum += particles_[i].mass *
             (dot(a[i].position, b[i].velocity) - dot(b[i].position, a[i].velocity) -
              particles_[i].omega * cross(a[i].position, b[i].position));
    return sum;
  }
  double mass() const {
    double sum = 0.0;
    for (const Particle& p : particles_) sum += p.mass;
    return sum;
  }

 private:
  const Table& table_;
  double step_;
  World world_;
  std::vector<Particle> particles_;
  std::vector<State> states_;
};

/// The largest defect over all pairs.
std::optional<double> defect(StepMap& map, const std::vector<Displacement>& along, double share) {
  std::vector<Displacement> images;
  for (const Displacement& one : along) {
    const auto image = map.derivative(one, share);
    if (!image) return {};
    images.push_back(*image);
  }
  double most = 0.0;
  for (std::size_t i = 0; i < along.size(); ++i)
    for (std::size_t j = i + 1; j < along.size(); ++j)
      most =
          std::max(most, std::fabs(map.form(images[i], images[j]) - map.form(along[i], along[j])));
  return most;
}

}  // namespace

std::optional<MeasuredNumber> defect_of_areas(const Runs& runs, const Setting& setting,
                                              const Dynamics& dynamics, double step) {
  const System& system = runs.system();
  const std::size_t n = runs.starts().size();
  const ErrorUnits units{std::min(setting.units.size, setting.units.speed * step),
                         setting.units.speed};
  std::vector<Displacement> along(vectors);
  for (int k = 0; k < vectors; ++k)
    for (std::size_t i = 0; i < n; ++i)
      along[static_cast<std::size_t>(k)].push_back(
          {units.size * Vector{entry(k, i, 0), entry(k, i, 1)},
           units.speed * Vector{entry(k, i, 2), entry(k, i, 3)}});
  // The places are those of a run, whose particles carry their masses and frequencies.
  World orbit(*system.table, dynamics);
  runs.add_starts(orbit);
  std::vector<Particle> particles;
  for (int i = 0; i < orbit.size(); ++i) particles.push_back(orbit.particle(i));
  StepMap map(runs, dynamics, step);
  std::optional<MeasuredNumber> most;
  for (int place = 1; place <= states_compared; ++place) {
    const double t = setting.t * place / states_compared;
    orbit.run_until(t);
    runs.stop_if_asked();
    std::vector<State> states;
    for (int i = 0; i < orbit.size() && !orbit.finished(i); ++i) {
      State s = orbit.state_at(i, t);
      s.time = Time(0.0);
      states.push_back(s);
    }
    if (states.size() < n) break;
    map.start_from(particles, states);
    const auto coarse = defect(map, along, displacement_of_map),
               fine = defect(map, along, finer * displacement_of_map);
    if (!coarse || !fine) continue;
    const double scale = map.mass() * units.size * units.speed;
    const MeasuredNumber found{*fine / scale, std::fabs(*fine - *coarse) / scale};
    if (!most) most = MeasuredNumber{};
    most->value = std::max(most->value, found.value);
    most->error = std::max(most->error, found.error);
  }
  return most;
}

}  // namespace carom::analyses
