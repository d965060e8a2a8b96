#include "certify/enclosure/trial_run.hpp"

#include <algorithm>
#include <vector>

#include "certify/enclosure/tangent.hpp"
#include "certify/flight/pseudo_orbit.hpp"

namespace carom::certify {
namespace {

// Variance of a sum of many terms, from sums over some sixteen to thirty-two blocks of equal
// length: neighbouring terms may be correlated.
class SumOfBlocks {
 public:
  void add(double sum_so_far) {
    if (++terms_ % length_ != 0) return;
    ends_.push_back(sum_so_far);
    if (ends_.size() < most) return;
    for (std::size_t i = 0; i < most / 2; ++i) ends_[i] = ends_[2 * i + 1];
    ends_.resize(most / 2);
    length_ *= 2;
  }
  /// The variance of a sum over `terms` terms.
  double variance(double terms) const {
    if (ends_.size() < 4) return 0.0;
    const auto blocks = static_cast<double>(ends_.size());
    const double mean = ends_.back() / blocks;
    double squares = 0.0, before = 0.0;
    for (const double end : ends_) {
      squares += (end - before - mean) * (end - before - mean);
      before = end;
    }
    return squares / (blocks - 1.0) * terms / static_cast<double>(length_);
  }

 private:
  static constexpr std::size_t most = 32;
  std::vector<double> ends_;
  std::uint64_t terms_ = 0, length_ = 1;
};

// So far the pseudo-orbit is the true one.
constexpr double true_bits = 45.0;
// Both orbits vary, which is a factor sqrt(2); the rest is for blocks that are not independent.
constexpr double of_both = 1.5;

}  // namespace

Forecast forecast(const SceneOf<double>& scene, const Whereabouts& where, geometry::Vector position,
                  geometry::Vector velocity, int standing, const Horizon& horizon, double unit) {
  Forecast result;
  FrameOf<double> frame{{1.0, 0.0}, velocity, unit};
  // The images of both directions, the longer one normalised: their logarithm grows.
  double a[2] = {1.0, 0.0}, b[2] = {0.0, 1.0};
  double grown = 0.0;
  SumOfBlocks sums;
  std::uint64_t true_hits = 0;
  PseudoState<double> s{position, velocity, 0.0, standing, {}};
  while (result.hits < horizon.hits && result.bits <= horizon.bits) {
    if (result.hits % 256 == 0 && horizon.interrupted != nullptr && *horizon.interrupted &&
        (*horizon.interrupted)())
      break;
    const Choice choice =
        scene.next(where, s.position, s.velocity, s.standing, s.position, s.velocity);
    if (choice.answer != Choice::wall) break;
    const Copy& copy = choice.first;
    const auto& wall = scene.walls[static_cast<std::size_t>(copy.wall)];
    const bool same = copy.wall == s.standing && copy.cell == geometry::Cell{};
    const geometry::Vector from =
        scene.lattice ? s.position - scene.translation(copy.cell) : s.position;
    const geometry::Vector before = s.velocity;
    fly_to(scene, copy, s);
    if (!(s.time <= horizon.t_max) || !std::isfinite(s.position.x)) break;
    if (scene.hole_at(copy.wall, s.position).verdict == Verdict::yes) break;
    const FrameOf<double> after{tangent_of(wall, s.position), s.velocity, unit};
    const auto map = tangent_map(wall, from, before, scene.motion, same, frame, after);
    const auto apply = [&map](double(&x)[2]) {
      const double along_wall = map.rows[along][along] * x[0] + map.rows[along][turning] * x[1];
      x[1] = map.rows[turning][along] * x[0] + map.rows[turning][turning] * x[1];
      x[0] = along_wall;
    };
    apply(a);
    apply(b);
    const double size = std::sqrt(a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1]);
    if (!(size > 0.0) || !std::isfinite(size)) break;
    const double now = grown + std::log2(size);
    result.bits = std::max(result.bits, now);
    sums.add(now);
    if (now < true_bits) true_hits = result.hits + 1;
    if (size > 0x1p100) {
      for (double* x : {&a[0], &a[1], &b[0], &b[1]}) *x /= size;
      grown += std::log2(size);
    }
    frame = after;
    ++result.hits;
    result.time = s.time;
    result.cells = std::fabs(static_cast<double>(s.cell.first)) +
                   std::fabs(static_cast<double>(s.cell.second));
  }
  result.spread = of_both * std::sqrt(sums.variance(static_cast<double>(result.hits - true_hits)));
  return result;
}

}  // namespace carom::certify
