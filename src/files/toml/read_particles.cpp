#include <cmath>
#include <utility>

#include "files/toml/read.hpp"

namespace carom::files {
namespace {

/// A quantity of the particles: one number for all, or a list with one each.
class Quantity {
 public:
  Quantity() = default;
  explicit Quantity(const Value& value)
      : place_(value.place), list_(value.kind == Value::Kind::list) {
    numbers_ = list_ ? as_numbers(value) : std::vector<ExactNumber>{as_number(value)};
    if (numbers_.empty())
      throw InputError(place_, "the list is empty", "a number for each particle");
  }

  bool given() const { return !numbers_.empty(); }
  bool is_list() const { return list_; }
  std::size_t size() const { return numbers_.size(); }
  const ExactNumber& operator[](std::size_t k) const { return numbers_[list_ ? k : 0]; }

  void check_count(std::uint64_t count) const {
    if (!list_ || size() == count) return;
    throw InputError(place_,
                     std::to_string(size()) + " values for " + std::to_string(count) + " particles",
                     "a number for each particle");
  }
  void check_not_negative() const {
    for (const ExactNumber& n : numbers_) {
      if (!(n.to_double() >= 0))
        throw InputError(n.place(), "must not be negative: " + n.text(), "a number >= 0");
    }
  }
  void check_positive() const {
    for (const ExactNumber& n : numbers_) {
      if (!(n.to_double() > 0)) {
        throw InputError(n.place(), "must be positive, not " + n.text(), "a number > 0");
      }
    }
  }

 private:
  Place place_;
  bool list_ = false;
  std::vector<ExactNumber> numbers_;
};

struct Speed {
  ExactNumber exact;
  double rounded = 0.0;
};

class Reader {
 public:
  explicit Reader(Value& root)
      : root_(root),
        particles_(*root.find("particles"), "particles"),
        field_(*root.find("field"), "field") {}

  std::vector<Particle> read() {
    particles_.check_keys();
    field_.check_keys();
    particles_.exclude("speed", "energy");
    field_.exclude("B", "larmor_radius");
    read_quantities();
    std::vector<Particle> result;
    for (std::size_t k = 0; k < count_; ++k) {
      result.push_back(k > 0 && !lists_ ? result.front() : particle(k));
    }
    return result;
  }

 private:
  void read_quantities() {
    mass_ = Quantity(particles_.get("mass"));
    mass_.check_positive();
    charge_ = Quantity(particles_.get("charge"));
    if (const Value* energy = particles_.find("energy")) {
      energy_ = Quantity(*energy);
    } else if (!particles_.has("speed") && speed_from_velocity()) {
      // the length of initial.velocity, see there
    } else {
      speed_ = Quantity(particles_.get("speed"));
      if (may_rest() && !field_.has("larmor_radius"))
        speed_.check_not_negative();  // a force or another disc will set it in motion
      else
        speed_.check_positive();
    }
    for (const Quantity* q : {&mass_, &charge_, &energy_, &speed_}) {
      if (!q->is_list()) continue;
      lists_ = true;
      if (!particles_.has("count")) {
        particles_.fill("count",
                        number_value(std::to_string(q->size()), particles_.place_of("count")));
      }
    }
    count_ = as_count(particles_.get("count"), 1, most_particles);
    for (const Quantity* q : {&mass_, &charge_, &energy_, &speed_}) q->check_count(count_);
    if (!energy_is_total()) energy_.check_positive();
    if (const Value* radius = field_.find("larmor_radius")) {
      as_positive(*radius);
      larmor_radius_ = as_number(*radius);
      check_equal();
    } else {
      field_strength_ = as_number(field_.get("B"));
    }
  }

  // With forces an energy is total, so a particle in a well may have a negative one.
  bool energy_is_total() const {
    if (root_.find("potential") != nullptr) return true;
    return root_.find("interaction") != nullptr && count_ > 1 && !hard_discs();
  }
  // Whether a force does act is known when all is read.
  bool may_rest() const {
    return root_.find("potential") != nullptr || root_.find("interaction") != nullptr;
  }
  bool hard_discs() const {
    const Value* interaction = root_.find("interaction");
    const Value* kind = interaction == nullptr ? nullptr : interaction->find("kind");
    return kind != nullptr && kind->text == "hard-discs";
  }

  // [initial] of kind point with a velocity: its length is the speed.
  bool speed_from_velocity() {
    Value& initial = *root_.find("initial");
    const Value* kind = initial.find("kind");
    const Value* velocity = initial.find("velocity");
    if (kind == nullptr || kind->text != "point" || velocity == nullptr) return false;
    const ExactPoint v = as_point(*velocity);
    const double x = v.x.to_double(), y = v.y.to_double();
    velocity_.rounded = std::sqrt(x * x + y * y);
    if (!(velocity_.rounded > 0) && !(may_rest() && !field_.has("larmor_radius"))) {
      throw InputError(velocity->place, "the velocity is zero", "a velocity that is not zero");
    }
    velocity_.exact =
        ExactNumber("sqrt(" + in_brackets(v.x) + "^2+" + in_brackets(v.y) + "^2)", velocity->place);
    by_velocity_ = true;
    return true;
  }

  Speed speed(std::size_t k) const {
    if (by_velocity_) return velocity_;
    if (energy_.given() && !(energy_[k].to_double() > 0)) {
      if (field_.has("larmor_radius"))
        throw InputError(
            energy_[k].place(),
            "there is no speed, and so no Larmor radius, at a total energy of " + energy_[k].text(),
            "B instead of larmor_radius");
      return {ExactNumber(1.0),
              1.0};  // gives starts a direction; their speed follows from the energy
    }
    ExactNumber exact =
        speed_.given()
            ? speed_[k]
            : ExactNumber("sqrt(2*" + in_brackets(energy_[k]) + "/" + in_brackets(mass_[k]) + ")",
                          energy_[k].place());
    const double rounded = exact.to_double();
    return {std::move(exact), rounded};
  }

  void check_equal() {
    const Place& place = larmor_radius_->place();
    for (std::size_t k = 0; k < count_; ++k) {
      if (charge_[k].to_double() == 0) {
        throw InputError(place, "a neutral particle has no Larmor radius",
                         "B, or a charge that is not 0");
      }
      if (!lists_) return;
      const bool equal = speed(k).rounded == speed(0).rounded &&
                         mass_[k].to_double() == mass_[0].to_double() &&
                         charge_[k].to_double() == charge_[0].to_double();
      if (equal) continue;
      throw InputError(
          place,
          "the particles differ in speed, mass or charge, so they have no common Larmor radius",
          "B instead of larmor_radius");
    }
  }

  Particle particle(std::size_t k) const {
    const Speed v = speed(k);
    Particle p;
    p.mass = mass_[k].to_double();
    p.charge = charge_[k].to_double();
    p.speed = v.rounded;
    if (larmor_radius_) {
      const std::string text = in_brackets(v.exact) + "/" + in_brackets(*larmor_radius_);
      const double omega = ExactNumber(text, larmor_radius_->place()).to_double();
      p.omega = p.charge < 0 ? -omega : omega;
    } else {
      const std::string text = in_brackets(charge_[k]) + "*" + in_brackets(*field_strength_) + "/" +
                               in_brackets(mass_[k]);
      p.omega = ExactNumber(text, field_strength_->place()).to_double();
    }
    return p;
  }

  Value& root_;
  TomlSection particles_, field_;
  Quantity mass_, charge_, energy_, speed_;
  Speed velocity_;
  std::optional<ExactNumber> larmor_radius_, field_strength_;
  std::uint64_t count_ = 1;
  bool lists_ = false, by_velocity_ = false;
};

}  // namespace

std::vector<double> read_energies(Value& root, std::size_t particles) {
  std::vector<double> energies;
  const Value* value = root.find("particles")->find("energy");
  if (value == nullptr) return energies;
  const Quantity energy(*value);
  for (std::size_t k = 0; k < particles; ++k) energies.push_back(energy[k].to_double());
  return energies;
}

std::vector<Particle> read_particles(Value& root) {
  Value& initial = *root.find("initial");
  const Value* position = initial.find("position");
  if (position != nullptr && initial.find("kind") == nullptr)
    initial.set("kind", text_value("point", position->place));
  take_starts_from_file(initial);
  take_speeds_from_starts(root);
  return Reader(root).read();
}

}  // namespace carom::files
