// What double runs say of themselves, against certified orbits of the same starts.
#include "carom/trust/trust.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "carom/analyses/run.hpp"
#include "carom/base/error.hpp"
#include "carom/certify/certified_orbit.hpp"
#include "carom/events/world.hpp"
#include "carom/files/system_file.hpp"
#include "carom/starts/sampler.hpp"
#include "certify/systems.hpp"
#include "random_tables.hpp"

namespace carom {
namespace {

using tests::Shaped;

struct Hits : Observer {
  explicit Hits(TrustRecorder& recorder) : trust(recorder) {}
  void hit(const HitEvent& event) override {
    trust.hit(event);
    events.push_back(event);
  }
  void end(const EndEvent& event) override { trust.end(event); }
  TrustRecorder& trust;
  std::vector<HitEvent> events;
};

struct Sample {
  long starts = 0, wrong = 0;
  std::vector<double> ratios;  ///< of orbits that part from the truth
};

class AgainstCertified {
 public:
  explicit AgainstCertified(const Shaped& s, const ExactNumber& omega) {
    system_ = tests::system_of(s, {1.0, 0.0});
    system_.omega = omega;
    loaded_.exact = system_;
    loaded_.system.table = system_.table;
    written_ = written_system(loaded_);
    particle_.omega = omega.to_double();
    world_ = std::make_unique<World>(*system_.table);
    world_->limit_hits(most);
    for (const Wall& wall : system_.table->walls) {
      const geometry::Box b = geometry::bounding_box(wall.curve);
      box_.low = {std::min(box_.low.x, b.low.x), std::min(box_.low.y, b.low.y)};
      box_.high = {std::max(box_.high.x, b.high.x), std::max(box_.high.y, b.high.y)};
    }
  }

  void run(tests::Dice& dice, Sample& sample) {
    State start;
    do
      start.position = {dice.between(box_.low.x, box_.high.x),
                        dice.between(box_.low.y, box_.high.y)};
    while (!world_->contains(start.position));
    start.velocity = dice.direction();
    world_->clear();
    world_->add(particle_, start);
    TrustRecorder recorder(*system_.table, TrustRecorder::usual_tolerance, written_);
    recorder.follow(particle_, start, 0);
    Hits doubles(recorder);
    world_->run_until(1e300, doubles);
    const std::uint64_t trusted = recorder.trust(0).hits;
    ++sample.starts;
    if (doubles.events.empty()) return;  // a cyclotron orbit that never hits

    system_.start.position = {start.position.x, start.position.y};
    system_.start.direction = {start.velocity.x, start.velocity.y};
    CertifiedTask task;
    task.collisions = std::min<std::uint64_t>(doubles.events.size(), trusted + 30);
    task.digits = 6;
    task.most_bits = 100'000;
    CertifiedOrbit truth(system_, task);
    std::uint64_t together = 0;
    bool parted = false;
    for (const CertifiedHit& hit : truth) {
      parted = !same(hit, doubles.events[static_cast<std::size_t>(together)]);
      if (parted) break;
      ++together;
    }
    if (together < trusted && ++sample.wrong)
      ADD_FAILURE() << system_.spec->shape << ", omega " << system_.omega.to_double()
                    << ": trusted " << trusted << ", together " << together << ", "
                    << name_of(truth.end_state().fate) << "; start " << std::hexfloat
                    << start.position.x << ", " << start.position.y << "; " << start.velocity.x
                    << ", " << start.velocity.y;
    if (parted)
      sample.ratios.push_back(static_cast<double>(trusted) / static_cast<double>(together));
  }

 private:
  bool same(const CertifiedHit& truth, const HitEvent& event) const {
    if (truth.wall != event.wall || !(truth.cell == event.cell)) return false;
    geometry::Vector position = event.position;
    const Table& table = *system_.table;
    if (table.lattice) position = position + table.lattice->translation(event.cell);
    const double size = size_of(table);
    const double away = std::max(std::fabs(truth.x.to_double() - position.x),
                                 std::fabs(truth.y.to_double() - position.y));
    const double turn = std::max(std::fabs(truth.vx.to_double() - event.after.x),
                                 std::fabs(truth.vy.to_double() - event.after.y));
    const double late = std::fabs(truth.t.to_double() - event.time.value());
    return std::max({away / size, late / size, turn}) <= 1e-3;
  }

  static constexpr std::uint64_t most = 300;
  ExactSystem system_;
  LoadedSystem loaded_;
  std::shared_ptr<const trust::WrittenSystem> written_;
  Particle particle_;
  std::unique_ptr<World> world_;
  geometry::Box box_{{1e9, 1e9}, {-1e9, -1e9}};
};

bool has_form(const Shaped& s, const ExactNumber& omega) {
  ExactSystem system = tests::system_of(s, {1.0, 0.0});
  system.omega = omega;
  CertifiedTask task;
  task.collisions = 1;
  try {
    const CertifiedOrbit orbit(system, task);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// Up to the last trusted collision the walls are those of the certified orbit, and the numbers
// within the tolerance; and the count is not much smaller than it could be.
TEST(TrustAgainstCertified, TheWallsAreTrue) {
  tests::Dice dice(21);
  std::vector<AgainstCertified> systems;
  for (const char* omega : {"0", "0.7", "-sqrt(2)", "5"})
    for (const Shaped& s : tests::all_shapes())
      if (has_form(s, tests::exactly(omega))) systems.emplace_back(s, tests::exactly(omega));
  ASSERT_GE(systems.size(), tests::all_shapes().size());
  Sample sample;
  const long starts = tests::cases(600, 20000);
  for (long k = 0; k < starts; ++k)
    systems[static_cast<std::size_t>(k) % systems.size()].run(dice, sample);
  EXPECT_LE(static_cast<double>(sample.wrong), 1e-3 * static_cast<double>(sample.starts));
  ASSERT_GT(sample.ratios.size(), static_cast<std::size_t>(starts / 3));
  std::sort(sample.ratios.begin(), sample.ratios.end());
  const double median = sample.ratios[sample.ratios.size() / 2];
  EXPECT_GE(median, 0.7);
  RecordProperty("systems", static_cast<int>(systems.size()));
  RecordProperty("wrong", static_cast<int>(sample.wrong));
  RecordProperty("parted", static_cast<int>(sample.ratios.size()));
  RecordProperty("least", std::to_string(sample.ratios.front()));
  RecordProperty("median", std::to_string(median));
  RecordProperty("largest", std::to_string(sample.ratios.back()));
}

// A trusted escape is a true one: through that hole, after as many hits, at that time.
TEST(TrustAgainstCertified, EscapesAreTrue) {
  const LoadedSystem loaded = read_system(
      "[table]\nshape = \"stadium\"\nhalf_length = \"2/3\"\nradius = 1.1\n"
      "[[table.hole]]\nwall = \"bottom\"\ncenter = 0.3\nwidth = 0.3\n"
      "[[table.hole]]\nwall = \"right\"\ncenter = 0.9\nwidth = \"1/7\"\n[particles]\nspeed = "
      "\"sqrt(2)\"\n",
      "test");
  const auto written = written_system(loaded);
  long trusted = 0, untrusted = 0;
  const long starts = tests::cases(300, 10000);
  for (long k = 0; k < starts; ++k) {
    SingleRunOptions options;
    const auto trajectory = static_cast<std::uint64_t>(k);
    options.trajectory = trajectory;
    options.written = written;
    Observer silent;
    const RunEnd run = run_single(loaded.system, silent, options).particles.front();
    if (run.progress.fate != Fate::escaped || !run.trust.open ||
        !(run.trust.time == run.progress.end)) {
      ++untrusted;
      continue;
    }
    ++trusted;
    const World world(*loaded.system.table);
    const State start = draw_initial_state(loaded.system, world, trajectory, 0);
    ExactSystem exact = loaded.exact;
    exact.start = {};
    exact.start.position = {start.position.x, start.position.y};
    exact.start.direction = {start.velocity.x, start.velocity.y};
    CertifiedTask task;
    task.digits = 6;
    task.collisions = run.progress.hits + 1;
    CertifiedOrbit truth(exact, task);
    const CertifiedEnd& end = truth.finish();
    ASSERT_EQ(end.fate, CertifiedFate::escaped) << k;
    ASSERT_EQ(end.hole, run.progress.hole) << k;
    ASSERT_EQ(end.collisions, run.progress.hits) << k;
    ASSERT_NEAR(end.t.to_double(), run.t, 1e-3 * size_of(*loaded.system.table) / std::sqrt(2.0))
        << k;
  }
  EXPECT_GT(trusted, starts / 3);
  EXPECT_GT(untrusted, starts / 20);
}

}  // namespace
}  // namespace carom
