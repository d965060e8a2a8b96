// [[potential]] and [interaction].
#include <utility>

#include "carom/forces/typed_expression.hpp"
#include "files/toml/read.hpp"

namespace carom::files {
namespace {

using PotentialKind = PotentialSpec::Kind;
using InteractionKind = InteractionSpec::Kind;

const std::pair<const char*, PotentialKind> potential_kinds[] = {
    {"fermi", PotentialKind::fermi},
    {"harmonic", PotentialKind::harmonic},
    {"gaussian", PotentialKind::gaussian},
    {"quartic", PotentialKind::quartic},
    {"power", PotentialKind::power},
    {"coulomb", PotentialKind::coulomb},
    {"henon-heiles", PotentialKind::henon_heiles},
    {"linear", PotentialKind::linear},
    {"soft-circle", PotentialKind::soft_circle},
    {"soft-stadium", PotentialKind::soft_stadium},
    {"expression", PotentialKind::expression},
};
const std::pair<const char*, InteractionKind> interaction_kinds[] = {
    {"coulomb", InteractionKind::coulomb},
    {"yukawa", InteractionKind::yukawa},
    {"lennard-jones", InteractionKind::lennard_jones},
    {"soft-sphere", InteractionKind::soft_sphere},
    {"hard-discs", InteractionKind::hard_discs},
    {"expression", InteractionKind::expression},
};

template <class Kind, std::size_t n>
std::pair<std::string, Kind> kind_in(Value& value, const char* section,
                                     const std::pair<const char*, Kind> (&kinds)[n]) {
  std::vector<std::string> names;
  for (const auto& [name, kind] : kinds) names.emplace_back(name);
  const std::string word = read_kind(value, section, "kind", names);
  for (const auto& [name, kind] : kinds)
    if (word == name) return {word, kind};
  return {word, kinds[0].second};
}

std::shared_ptr<const TypedExpression> expression_in(TomlSection& section,
                                                     std::vector<std::string> variables) {
  const Value& text = section.get("expression");
  std::map<std::string, double> parameters;
  if (const Value* table = section.find("parameters")) {
    if (table->kind != Value::Kind::table)
      throw InputError(table->place, "the parameters are not a table", "{ name = number, … }");
    for (const Entry& entry : table->entries) parameters[entry.key] = as_double(entry.value);
  }
  Place first = text.place;  // of the opening quote
  if (first.column > 0) ++first.column;
  return std::make_shared<TypedExpression>(
      TypedExpression::parse(as_text(text), variables, parameters, first));
}

double number(TomlSection& section, const char* key) { return as_double(section.get(key)); }
double positive(TomlSection& section, const char* key) { return as_positive(section.get(key)); }

PotentialSpec read_potential(Value& value) {
  PotentialSpec spec;
  spec.place = value.place;
  const auto [name, kind] = kind_in(value, "potential", potential_kinds);
  spec.kind = kind;
  TomlSection section(value, "potential", name);
  section.check_keys();
  switch (kind) {
    case PotentialKind::fermi:
    case PotentialKind::soft_circle:
    case PotentialKind::soft_stadium:
      spec.height = number(section, "height");
      spec.radius = positive(section, "radius");
      spec.softness = positive(section, "softness");
      if (kind == PotentialKind::soft_stadium) spec.half_length = positive(section, "half_length");
      break;
    case PotentialKind::harmonic:
      section.exclude("omega", "omega_x");
      section.exclude("omega", "omega_y");
      if (section.has("omega_x") || section.has("omega_y")) {
        spec.omega_x = number(section, "omega_x");
        spec.omega_y = number(section, "omega_y");
      } else {
        spec.omega_x = spec.omega_y = number(section, "omega");
      }
      break;
    case PotentialKind::gaussian:
      spec.height = number(section, "height");
      spec.width = positive(section, "width");
      break;
    case PotentialKind::quartic:
      spec.strength = number(section, "strength");
      break;
    case PotentialKind::power:
      spec.strength = number(section, "strength");
      spec.exponent = number(section, "exponent");
      if (spec.exponent < 0.0 && spec.strength < 0.0)
        throw InputError(section.place_of("strength"),
                         "the potential attracts without bound at its centre",
                         "strength > 0, or exponent > 0");
      break;
    case PotentialKind::coulomb:
      spec.charge = number(section, "charge");
      break;
    case PotentialKind::linear:
      spec.force = as_vector(section.get("force"));
      break;
    case PotentialKind::expression:
      spec.expression = expression_in(section, {"x", "y"});
      break;
    case PotentialKind::henon_heiles:
      break;
  }
  section.exclude("center", "centers");
  if (const Value* center = section.find("center")) spec.centers = {as_vector(*center)};
  if (const Value* centers = section.find("centers")) {
    spec.centers.clear();
    for (const ExactPoint& p : as_points(*centers))
      spec.centers.push_back({p.x.to_double(), p.y.to_double()});
    if (spec.centers.empty())
      throw InputError(centers->place, "the list is empty", "a list of points [x, y]");
  }
  spec.lattice = as_flag(section.get("lattice"));
  return spec;
}

InteractionSpec read_interaction(Value& value, std::size_t particles) {
  InteractionSpec spec;
  spec.place = value.place;
  const auto [name, kind] = kind_in(value, "interaction", interaction_kinds);
  spec.kind = kind;
  TomlSection section(value, "interaction", name);
  section.check_keys();
  switch (kind) {
    case InteractionKind::coulomb:
      spec.strength = number(section, "strength");
      break;
    case InteractionKind::yukawa:
      spec.strength = number(section, "strength");
      spec.range = positive(section, "range");
      break;
    case InteractionKind::lennard_jones:
      spec.depth = positive(section, "depth");
      spec.diameter = positive(section, "diameter");
      break;
    case InteractionKind::soft_sphere:
      spec.strength = positive(section, "strength");
      spec.diameter = positive(section, "diameter");
      spec.exponent = static_cast<int>(as_count(section.get("exponent"), 1, 100));
      break;
    case InteractionKind::hard_discs:
      section.exclude("radius", "radii");
      if (const Value* radii = section.find("radii")) {
        for (const ExactNumber& r : as_numbers(*radii)) {
          if (!(r.to_double() > 0.0))
            throw InputError(r.place(), "must be positive, not " + r.text(), "a radius > 0");
          spec.radii.push_back(r.to_double());
        }
        if (spec.radii.size() != particles)
          throw InputError(radii->place,
                           std::to_string(spec.radii.size()) + " radii for " +
                               std::to_string(particles) + " particles",
                           "a radius for each particle");
      } else {
        spec.radii.assign(particles, positive(section, "radius"));
      }
      break;
    case InteractionKind::expression:
      spec.expression = expression_in(section, {"r"});
      break;
  }
  return spec;
}

}  // namespace

ForceSpec read_forces(Value& root, std::size_t particles) {
  ForceSpec spec;
  if (Value* potentials = root.find("potential")) {
    as_sections(*potentials, "kind = \"harmonic\"");
    for (Value& potential : potentials->items) spec.potentials.push_back(read_potential(potential));
  }
  if (Value* interaction = root.find("interaction"))
    spec.interaction = read_interaction(*interaction, particles);
  return spec;
}

}  // namespace carom::files
