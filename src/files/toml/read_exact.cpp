// The numbers of a system as they were written, for certified orbits.
#include "files/toml/read.hpp"

namespace carom::files {
namespace {

// One number for all particles, or the first of a list.
ExactNumber first_of(const Value& value) {
  return value.kind == Value::Kind::list ? as_number(value.items.front()) : as_number(value);
}

ExactNumber speed_of(const Value& particles, const Value& initial) {
  if (const Value* speed = particles.find("speed")) return first_of(*speed);
  if (const Value* energy = particles.find("energy"))
    return {"sqrt(2*" + in_brackets(first_of(*energy)) + "/" +
                in_brackets(first_of(*particles.find("mass"))) + ")",
            energy->place};
  const Value* velocity = initial.find("velocity");
  if (velocity == nullptr) return {1.0};
  const ExactPoint v = as_point(*velocity);
  return {"sqrt(" + in_brackets(v.x) + "^2+" + in_brackets(v.y) + "^2)", velocity->place};
}

ExactNumber omega_of(const Value& particles, const Value& field, const ExactNumber& speed) {
  const ExactNumber charge = first_of(*particles.find("charge"));
  if (const Value* radius = field.find("larmor_radius")) {
    const std::string sign = charge.to_double() < 0 ? "-" : "";
    return {sign + in_brackets(speed) + "/" + in_brackets(as_number(*radius)), radius->place};
  }
  const Value& strength = *field.find("B");
  return {in_brackets(charge) + "*" + in_brackets(as_number(strength)) + "/" +
              in_brackets(first_of(*particles.find("mass"))),
          strength.place};
}

}  // namespace

ExactSystem read_exact(Value& root, bool free) {
  const Value &particles = *root.find("particles"), &initial = *root.find("initial");
  ExactSystem exact;
  // Energies are total where forces act, and may leave no speed: no certified orbit asks for it.
  if (!free) return exact;
  exact.speed = speed_of(particles, initial);
  exact.omega = omega_of(particles, *root.find("field"), exact.speed);
  if (initial.find("kind")->text == "point") {
    exact.start.position = as_point(*initial.find("position"));
    if (const Value* angle = initial.find("angle"))
      exact.start.angle = as_angle(*angle);
    else
      exact.start.direction = as_point(*initial.find("velocity"));
  }
  return exact;
}

}  // namespace carom::files
