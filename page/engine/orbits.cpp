// Orbits that fly on as far as the page asks.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>

#include "carom/analyses/run.hpp"
#include "carom/analyses/run/rows.hpp"
#include "carom/base/error.hpp"
#include "carom/events/medium.hpp"
#include "growth.hpp"
#include "systems.hpp"

namespace carom::page {

namespace {

using geometry::Vector;

/// The particles of one world: one, or all that act on each other.
class Flight final : public Observer {
 public:
  Flight(std::shared_ptr<OpenSystem> open, const Request& start)
      : open_(std::move(open)), world_(open_->world.empty_copy()) {
    add(start);
    rows_.resize(states_.size());
    ends_.resize(states_.size());
    if (start.get("trust", false) && estimates_trust(system())) {
      trust_.emplace(table(), system().run.trust_tolerance);
      for (std::size_t p = 0; p < states_.size(); ++p)
        trust_->follow(system().particles[p], states_[p], 0);
    }
    follows_growth_ = start.get("rates", false);
    if (follows_growth_ && !forced()) growth_.emplace(system(), world_);
    world_.stop_when([this] { return rows_[asked_].size() >= wanted_; });
  }
  Flight(const Flight&) = delete;

  std::size_t particles() const { return states_.size(); }
  const std::optional<EndEvent>& end_of(std::size_t particle) const { return ends_[particle]; }
  const std::string& report(std::size_t particle) const {
    return world_.report(static_cast<int>(particle));
  }
  DecisionCounts decisions() const { return world_.decisions(); }
  double now(std::size_t particle) const {
    return world_.state(static_cast<int>(particle)).time.value();
  }
  /// Nothing where it was not asked for, or cannot be estimated.
  const Trust* trust(std::size_t particle) const {
    return trust_ ? &trust_->trust(static_cast<int>(particle)) : nullptr;
  }
  const System& system() const { return open_->system(); }
  const Table& table() const { return *system().table; }

  /// Writes at most `n` further hits of a particle; fewer where it ends, or where it has taken long
  /// without one.
  std::size_t step(std::size_t particle, std::size_t n, double* out) {
    asked_ = particle;
    wanted_ = n;
    std::deque<Row>& rows = rows_[particle];
    if (rows.size() < n && !world_.finished(static_cast<int>(particle))) fly();
    const std::size_t count = std::min(n, rows.size());
    for (std::size_t i = 0; i < count; ++i, rows.pop_front(), out += row)
      std::copy(rows.front().begin(), rows.front().end(), out);
    return count;
  }

  /// Where a particle is at a time, earlier than its last hits as well.
  void place(std::size_t particle, double t, double* out) {
    if (!places_ || t < places_->time) {
      places_.emplace(Places{open_->world.empty_copy(), 0.0});
      start(places_->world);
      // Where forces act deviations go beside the world that gives places.
      if (follows_growth_ && forced()) growth_.emplace(system(), places_->world);
    }
    if (follows_growth_ && forced())
      places_->world.run_until(t, *growth_);
    else
      places_->world.run_until(t);
    places_->time = t;
    const auto number = static_cast<int>(particle);
    const SampleRow at = sample_row(number, t, places_->world.state_at(number, t), table());
    for (const double x : {at.x, at.y, at.vx, at.vy}) *out++ = x;
  }

  /// How fast deviations have grown until t, or a later event that was read ahead; 0: they are not
  /// followed.
  double rate(std::size_t particle, double t) {
    std::array<double, 4> there;
    if (follows_growth_ && forced()) place(particle, t, there.data());
    return growth_ ? growth_->rate(particle, t) : 0.0;
  }

  static constexpr std::size_t row = 9;

 private:
  using Row = std::array<double, row>;
  struct Places {
    World world;
    double time;
  };

  bool forced() const { return system().has_forces(); }
  void add(const Request& start) {
    const std::size_t all = act_on_each_other(system()) ? system().particles.size() : 1;
    const auto seed = start.get_optional<std::uint64_t>("seed");
    trajectory_ = start.get<std::uint64_t>("trajectory", 0);
    Starts& written = open_->starts();
    written.system.run.seed = seed.value_or(system().run.seed);
    if (seed && all > 1) {
      states_ = written.sampler.draw_all(world_, trajectory_);
    } else {
      states_.push_back(seed ? written.sampler.draw(world_, trajectory_, 0) : given(start));
      for (std::size_t p = 1; p < all; ++p)
        states_.push_back(written.sampler.draw(world_, trajectory_, static_cast<int>(p)));
    }
    this->start(world_);
  }
  void start(World& world) const {
    for (std::size_t p = 0; p < states_.size(); ++p)
      add_start(world, open_->starts().system, states_[p], trajectory_, static_cast<int>(p));
  }

  State given(const Request& start) {
    const auto pair = [&](const char* key) {
      Vector v;
      double* to[] = {&v.x, &v.y};
      std::size_t i = 0;
      for (const auto& [name, number] : start.get_child(key))
        if (i < 2) *to[i++] = number.get_value<double>();
      return v;
    };
    if (start.count("position") > 0) {
      Starts& point = open_->starts_at(InitialCondition::Kind::point);
      point.system.initial.position = pair("position");
      point.system.initial.velocity = pair("velocity");
      return point.sampler.draw(world_, 0, 0);
    }
    Starts& wall = open_->starts_at(InitialCondition::Kind::birkhoff);
    wall.system.initial.s = {start.get("s", 0.0)};
    wall.system.initial.v_parallel = {start.get("v", 0.0) * system().particles.front().speed};
    return wall.sampler.draw(world_, 0, 0);
  }

  // Without walls there are no hits to wait for.
  void fly() {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::milliseconds(200);
    world_.run_until(no_last_time, *this, [end] { return Clock::now() > end; });
  }

  // Of the flight that led to a hit, positive to the left; where forces act it has none.
  double curvature_before(const HitEvent& event) const {
    if (forced()) return 0.0;
    const Particle& outside = system().particles[static_cast<std::size_t>(event.particle)];
    int region = -1;
    if (!table().regions.empty()) {
      // The wall as it is seen from where the particle flies on. Did it come from behind?
      const geometry::CurveFrame& frame = open_->frames[static_cast<std::size_t>(event.wall)];
      const bool behind = dot(event.before, geometry::normal_at(frame, event.u)) > 0.0;
      region = region_of(table(), behind ? table().wall(event.wall).twin : event.wall);
    }
    const Particle there = in_region(table(), outside, region);
    return there.omega != 0.0 ? -there.omega / there.speed : 0.0;
  }

  void hit(const HitEvent& event) override {
    if (trust_) trust_->hit(event);
    if (growth_ && !forced()) growth_->hit(event);
    const auto particle = static_cast<std::size_t>(event.particle);
    const HitRow hit = hit_row(event, table(), open_->frames);
    const double s = open_->offsets[static_cast<std::size_t>(hit.wall)] + hit.s;
    rows_[particle].push_back({hit.t, hit.x, hit.y, hit.vx, hit.vy, static_cast<double>(hit.wall),
                               s, hit.v_parallel, curvature_before(event)});
  }
  void contact(const ContactEvent& event) override {
    if (growth_) growth_->contact(event);
  }
  void end(const EndEvent& event) override {
    if (trust_) trust_->end(event);
    ends_[static_cast<std::size_t>(event.particle)] = event;
  }

  std::shared_ptr<OpenSystem> open_;
  World world_;
  std::uint64_t trajectory_ = 0;
  std::vector<State> states_;  ///< where it began
  std::vector<std::deque<Row>> rows_;
  std::vector<std::optional<EndEvent>> ends_;
  std::size_t asked_ = 0, wanted_ = 1;
  std::optional<Places> places_;
  std::optional<TrustRecorder> trust_;
  bool follows_growth_ = false;
  std::optional<Growth> growth_;
};

struct Orbit {
  std::shared_ptr<Flight> flight;
  std::size_t particle = 0;
};
std::map<int, Orbit>& orbits() {
  static std::map<int, Orbit> all;
  return all;
}
Orbit* find(int id) {
  const auto found = orbits().find(id);
  return found == orbits().end() ? nullptr : &found->second;
}
Orbit& orbit_of(const Request& request) {
  Orbit* const found = find(request.get("orbit", 0));
  if (!found) throw InputError("this orbit is not flown any more");
  return *found;
}

}  // namespace

Json begin_orbit(const Request& request) {
  static int last = 0;
  const auto start = request.get_child_optional("start");
  if (!start) throw InputError("an orbit needs its start");
  const auto flight = std::make_shared<Flight>(system_of(request), *start);
  const int first = last + 1;
  for (std::size_t p = 0; p < flight->particles(); ++p) orbits()[++last] = {flight, p};
  return Json::object().set("orbit", first).set("particles", flight->particles());
}

Json forget_orbit(const Request& request) {
  orbits().erase(request.get("orbit", 0));
  return Json::object();
}

Json end_of_orbit(const Request& request) {
  const Orbit& orbit = orbit_of(request);
  const auto& end = orbit.flight->end_of(orbit.particle);
  if (!end) return Json::object().set("why", "").set("t", orbit.flight->now(orbit.particle));
  Json json = Json::object().set("why", name_of(end->fate)).set("t", end->time.value());
  if (end->hole >= 0)
    json.set("hole", orbit.flight->table().holes[static_cast<std::size_t>(end->hole)].name);
  if (is_failure(end->fate)) json.set("report", orbit.flight->report(orbit.particle));
  return json;
}

Json decisions_of_orbit(const Request& request) {
  const DecisionCounts counts = orbit_of(request).flight->decisions();
  return Json::object().set("filter", counts.filter).set("exact", counts.exact);
}

Json trust_of_orbit(const Request& request) {
  const Orbit& orbit = orbit_of(request);
  const Trust* const trust = orbit.flight->trust(orbit.particle);
  if (!trust || !trust->known) return Json::object().set("known", false);
  return Json::object()
      .set("known", true)
      .set("open", trust->open)
      .set("hits", trust->hits)
      .set("t", trust->time.value());
}

}  // namespace carom::page

extern "C" {

/// At most n further hits of an orbit, 9 numbers each; how many.
int carom_step(int orbit, int n, double* rows) {
  carom::page::Orbit* const found = carom::page::find(orbit);
  if (!found || n <= 0) return 0;
  return static_cast<int>(found->flight->step(found->particle, static_cast<std::size_t>(n), rows));
}
/// x, y, vx, vy of each of n orbits at time t.
void carom_places(const int* orbits, int n, double t, double* out) {
  for (int i = 0; i < n; ++i, out += 4)
    if (carom::page::Orbit* const found = carom::page::find(orbits[i]))
      found->flight->place(found->particle, t, out);
}
/// How fast deviations of each of n orbits have grown.
void carom_rates(const int* orbits, int n, double t, double* out) {
  for (int i = 0; i < n; ++i) {
    carom::page::Orbit* const found = carom::page::find(orbits[i]);
    out[i] = found ? found->flight->rate(found->particle, t) : 0.0;
  }
}
}
