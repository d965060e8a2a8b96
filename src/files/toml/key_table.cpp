// The one table of keys: parser, hints, --set and the guide's page are made from it.
#include <fmt/format.h>

#include "carom/files/system_file.hpp"

namespace carom {

const std::vector<KeyDescription>& key_table() {
  static const std::vector<KeyDescription> keys{
      {"", "", "title", "string", "\"\"", "description of the system; only for readers"},

      {"table", "", "shape", "string", "",
       "rectangle, polygon, triangle, regular, circle, ellipse, annulus, stadium, mushroom, lemon, "
       "sinai, "
       "lorentz, discs, random-discs, cardioid, limacon, flower, superellipse, robnik, egg, path, "
       "polar, "
       "parametric, implicit, spline, svg (a drawing) or plane (no walls)"},
      {"table", "rectangle", "width", "number", "", "extent along x, from 0"},
      {"table", "rectangle", "height", "number", "", "extent along y, from 0"},
      {"table", "polygon|triangle", "points", "list of points", "",
       "the corners, either way round"},
      {"table", "regular", "sides", "whole number", "", "number of sides"},
      {"table",
       "regular|circle|stadium|lemon|sinai|lorentz|discs|random-discs|cardioid|limacon|flower|"
       "robnik",
       "radius", "number", "",
       "radius of the circle, the caps, the arcs or the discs; of the circumscribed circle for "
       "regular; of the undeformed circle for curves"},
      {"table", "polar", "radius", "formula", "",
       "distance of the wall from the origin, a formula in the angle phi: \"1 + 0.5*cos(phi)\""},
      {"table", "parametric", "x", "formula", "",
       "the wall's x, a formula in the parameter t: \"2*cos(t)\""},
      {"table", "parametric", "y", "formula", "", "its y"},
      {"table", "parametric", "from", "number", "0", "where t begins"},
      {"table", "parametric", "to", "number", "\"2*pi\"",
       "where t ends; the wall and all its derivatives must be the same as at the start"},
      {"table", "implicit", "equation", "formula", "",
       "a formula of x and y that vanishes on the wall and changes its sign there: \"x^4 + y^4 - "
       "1\""},
      {"table", "implicit", "inside", "point", "[0, 0]",
       "a point of the domain: the wall is the curve on its right"},
      {"table", "spline", "points", "list of points", "",
       "points that the wall passes through, either way round"},
      {"table", "regular", "angle", "angle", "0", "direction of the first corner against +x"},
      {"table", "ellipse|superellipse|egg", "a", "number", "", "semi-axis along x"},
      {"table", "ellipse|superellipse|egg", "b", "number", "", "semi-axis along y"},
      {"table", "superellipse", "exponent", "whole number", "", "n, even, from 2 to 20"},
      {"table", "limacon|flower|egg", "epsilon", "number", "",
       "size of the deformation, above -1 and below 1"},
      {"table", "flower", "petals", "whole number", "", "number of waves, from 1 to 100"},
      {"table", "robnik", "lambda", "number", "",
       "size of the deformation, above -1/2 and below 1/2"},
      {"table", "annulus", "outer", "number", "",
       "radius of the outer circle, centred at the origin"},
      {"table", "annulus", "inner", "number", "", "radius of the inner circle"},
      {"table", "annulus", "offset", "number", "0", "x of the inner circle's centre"},
      {"table", "stadium", "half_length", "number", "", "half the length of a straight wall"},
      {"table", "mushroom", "cap_radius", "number", "", "radius of the half-circular cap"},
      {"table", "mushroom", "stem_width", "number", "",
       "width of the stem, at most twice cap_radius"},
      {"table", "mushroom", "stem_height", "number", "", "height of the stem"},
      {"table", "lemon", "separation", "number", "",
       "distance of the two circles' centres, below 2 radius"},
      {"table", "sinai|random-discs", "side", "number", "", "side of the square"},
      {"table", "sinai|random-discs", "torus", "boolean", "true",
       "true: opposite sides are one; false: the sides are walls"},
      {"table", "lorentz", "lattice", "string", "\"triangular\"", "triangular or square"},
      {"table", "lorentz", "spacing", "number", "", "distance of neighbouring discs' centres"},
      {"table", "discs", "centers", "list of points", "", "the discs' centres"},
      {"table", "discs", "radii", "list of numbers", "",
       "a radius for each disc, instead of radius"},
      {"table", "polygon|spline|discs", "path", "string", "",
       "instead of points or centers: a text file with x y in each line, or x y radius for discs"},
      {"table", "svg", "path", "string", "",
       "a drawing (SVG): its outermost curve is the table, all others are obstacles"},
      {"table", "svg", "scale", "number", "1", "length of the drawing's unit"},
      {"table", "random-discs", "count", "whole number", "",
       "number of discs, placed at random without overlap"},
      {"table", "random-discs", "seed", "whole number", "1", "of the arrangement"},
      {"table", "path", "loop", "list of tables", "", "closed loops of pieces: [[table.loop]]"},
      {"table", "", "obstacle", "list of tables", "",
       "closed walls inside the table or in the cell: [[table.obstacle]]"},
      {"table", "", "hole", "list of tables", "", "openings of walls: [[table.hole]]"},
      {"table", "", "wall", "list of tables", "", "how walls reflect: [[table.wall]]"},
      {"table", "", "region", "list of tables", "",
       "parts of the table, or obstacles, with another field: [[table.region]]"},

      {"table.obstacle", "", "shape", "string", "",
       "circle, ellipse, polygon, path, polar, parametric or spline"},
      {"table.obstacle", "circle|ellipse", "center", "point", "", "its centre"},
      {"table.obstacle", "polar", "center", "point", "[0, 0]", "centre of its polar coordinates"},
      {"table.obstacle", "circle", "radius", "number", "", "its radius"},
      {"table.obstacle", "polar", "radius", "formula", "",
       "distance of the wall from center, a formula in the angle phi"},
      {"table.obstacle", "parametric", "x", "formula", "",
       "the wall's x, a formula in the parameter t"},
      {"table.obstacle", "parametric", "y", "formula", "", "its y"},
      {"table.obstacle", "parametric", "from", "number", "0", "where t begins"},
      {"table.obstacle", "parametric", "to", "number", "\"2*pi\"", "where t ends"},
      {"table.obstacle", "ellipse", "a", "number", "", "one semi-axis"},
      {"table.obstacle", "ellipse", "b", "number", "", "the other semi-axis"},
      {"table.obstacle", "ellipse", "angle", "angle", "0", "angle of the semi-axis a against +x"},
      {"table.obstacle", "polygon|spline", "points", "list of points", "",
       "the corners, or points that the wall passes through; either way round"},
      {"table.obstacle", "polygon|spline", "path", "string", "",
       "instead of points: a text file with x y in each line"},
      {"table.obstacle", "path", "start", "point", "",
       "where the first piece begins and the last must end"},
      {"table.obstacle", "path", "pieces", "list of tables", "",
       "as in [[table.loop]], either way round"},
      {"table.obstacle", "", "name", "string", "",
       "name of its wall; of several walls the start of the names NAME_side_1, NAME_side_2 … for a "
       "polygon, NAME_1, NAME_2 … for others; obstacle_1, obstacle_2 … if not given"},

      {"table.hole", "", "wall", "string", "", "name of the wall"},
      {"table.hole", "", "center", "number", "",
       "arc length from the wall's start to the hole's centre"},
      {"table.hole", "", "width", "number", "", "arc length of the hole"},
      {"table.hole", "", "name", "string", "", "a name; hole_1, hole_2 … if not given"},
      {"table.hole", "", "transmission", "number", "1",
       "fraction of the hits that pass, at random; the others follow the law of the wall"},

      {"table.wall", "", "law", "string", "",
       "specular; diffuse: by Lambert's law, with a uniform sine of the angle to the normal; "
       "mixed; rough; or thermal: with the velocities of a gas that leaves the wall"},
      {"table.wall", "mixed", "specularity", "number", "",
       "fraction of the hits that are mirrored; the others are diffuse"},
      {"table.wall", "rough", "angle", "angle", "",
       "the normal is turned by a random angle, uniform from -angle to angle"},
      {"table.wall", "thermal", "temperature", "number", "",
       "temperature as an energy: the mean kinetic energy of a particle of the gas"},
      {"table.wall", "", "wall", "string", "", "name of the wall; all walls if not given"},

      {"table.region", "obstacle", "wall", "string", "",
       "a wall of the obstacle that particles enter"},
      {"table.region", "pieces", "start", "point", "",
       "a corner of the table, where the region's edge begins"},
      {"table.region", "pieces", "pieces", "list of tables", "",
       "as in [[table.loop]], to another corner of the same loop; the region is on their left"},
      {"table.region", "", "B", "number", "", "magnetic field inside; that outside if not given"},
      {"table.region", "", "potential", "number", "0",
       "potential energy inside; it is 0 outside, where particles have their given speed"},
      {"table.region", "", "index", "number", "1",
       "refractive index inside, relative to the outside: the speed is divided by it"},
      {"table.region", "", "reflection", "string", "none",
       "hits that are mirrored although they could pass: none; or at random as a wave, s or p "
       "(Fresnel), or a formula of their fraction in the angles incidence and refraction and in n"},

      {"table.loop", "pieces", "start", "point", "",
       "where the first piece begins and the last must end"},
      {"table.loop", "pieces", "pieces", "list of tables", "",
       "outer loops run counter-clockwise, obstacles clockwise"},
      {"table.loop", "circle|ellipse", "center", "point", "",
       "centre of a whole circle or ellipse as the outer wall"},
      {"table.loop", "circle", "radius", "number", "", "its radius"},
      {"table.loop", "ellipse", "a", "number", "", "one semi-axis"},
      {"table.loop", "ellipse", "b", "number", "", "the other semi-axis"},
      {"table.loop", "ellipse", "angle", "angle", "0", "angle of the semi-axis a against +x"},
      {"table.loop", "circle|ellipse", "name", "string", "",
       "the wall's name; wall_1, wall_2 … if not given"},
      {"table.loop.pieces", "line", "line_to", "point", "", "a straight piece to this point"},
      {"table.loop.pieces", "arc", "arc_to", "point", "", "a circular arc to this point"},
      {"table.loop.pieces", "arc", "arc_via", "point", "", "a point on that arc"},
      {"table.loop.pieces", "bezier", "bezier", "list of points", "",
       "a Bézier curve: 1 to 4 control points, then its end"},
      {"table.loop.pieces", "ellipse", "ellipse_to", "point", "", "an elliptic arc to this point"},
      {"table.loop.pieces", "ellipse", "ellipse_via", "point", "", "a point on that arc"},
      {"table.loop.pieces", "ellipse", "ellipse_ratio", "number", "", "minor over major axis"},
      {"table.loop.pieces", "ellipse", "ellipse_angle", "angle", "0",
       "angle of the major axis against +x"},
      {"table.loop.pieces", "", "name", "string", "",
       "the wall's name; wall_1, wall_2 … if not given"},

      {"lattice", "", "vectors", "list of points", "",
       "two vectors by which the obstacles of discs or path are repeated"},

      {"field", "", "B", "number", "0", "magnetic field; B > 0 turns a positive charge clockwise"},
      {"field", "", "larmor_radius", "number", "",
       "radius of the Larmor circles instead of B, which is then > 0; with forces and an energy: "
       "the radius where the potential is 0"},

      {"particles", "", "count", "whole number", "1", "number of particles"},
      {"particles", "", "speed", "number or list", "1",
       "speed; if neither it nor energy is given, the length of initial.velocity or of the "
       "velocities of the starts"},
      {"particles", "", "energy", "number or list", "",
       "energy instead of speed: kinetic, and potential where forces act; interacting particles "
       "share the sum"},
      {"particles", "", "mass", "number or list", "1", "mass"},
      {"particles", "", "charge", "number or list", "1", "charge, of either sign or 0"},

      {"initial", "", "kind", "string", "\"uniform\"",
       "uniform, sobol, boundary, hole, point, birkhoff, rectangle, line, list or file"},
      {"initial", "boundary|birkhoff", "wall", "string", "",
       "the wall to start from; boundary without it: all walls"},
      {"initial", "boundary|hole", "hole", "string", "", "the hole to start from, into the table"},
      {"initial", "point", "position", "point", "", "where all trajectories start"},
      {"initial", "point", "velocity", "point", "",
       "direction of flight, and the speed if [particles] gives none"},
      {"initial", "point|line", "angle", "angle", "", "direction of flight against +x"},
      {"initial", "birkhoff", "s", "number, list or grid", "", "arc length along the wall"},
      {"initial", "birkhoff", "v_parallel", "number, list or grid", "",
       "component of the velocity along the wall, in the direction of s"},
      {"initial", "rectangle", "min", "point", "", "corner with the smaller coordinates"},
      {"initial", "rectangle", "max", "point", "", "corner with the larger coordinates"},
      {"initial", "line", "from", "point", "", "one end of the line of starts"},
      {"initial", "line", "to", "point", "", "its other end"},
      {"initial", "list", "starts", "list of lists", "",
       "one [x, y, vx, vy] for each trajectory; without a speed in [particles] the velocity also "
       "gives the speed"},
      {"initial", "file", "path", "string", "",
       "a text file with x y vx vy in each line, relative to the system file"},
      {"initial.grid", "", "from", "number", "", "first value of a grid {from, to, count}"},
      {"initial.grid", "", "to", "number", "", "its last value"},
      {"initial.grid", "", "count", "whole number", "", "number of values, at least 2"},

      {"injection", "", "hole", "string", "", "the hole that particles enter through"},
      {"injection", "", "times", "list of numbers", "",
       "entry times of single particles, in increasing order, at most t_max"},
      {"injection", "", "rate", "number", "",
       "mean number that enter per unit time, at random until t_max; instead of times"},
      {"injection", "", "speed", "number", "",
       "their speed; if not given, that of the first particle"},

      {"potential", "", "kind", "string", "",
       "fermi, harmonic, gaussian, quartic, power, coulomb, henon-heiles, linear, soft-circle, "
       "soft-stadium or "
       "expression"},
      {"potential", "fermi|gaussian|soft-circle|soft-stadium", "height", "number", "1",
       "at the centre, or far outside"},
      {"potential", "fermi|soft-circle|soft-stadium", "radius", "number", "",
       "where the potential is half its height"},
      {"potential", "fermi|soft-circle|soft-stadium", "softness", "number", "",
       "width of the edge"},
      {"potential", "soft-stadium", "half_length", "number", "",
       "half the distance of the caps' centres"},
      {"potential", "harmonic", "omega", "number", "1", "angular frequency"},
      {"potential", "harmonic", "omega_x", "number", "",
       "angular frequencies along x and y, instead of omega"},
      {"potential", "harmonic", "omega_y", "number", "", "see omega_x"},
      {"potential", "gaussian", "width", "number", "", "standard deviation of the bell"},
      {"potential", "quartic|power", "strength", "number", "1", "factor of the power of r"},
      {"potential", "power", "exponent", "number", "", "the power"},
      {"potential", "coulomb", "charge", "number", "1",
       "of the centre; it must repel every particle"},
      {"potential", "linear", "force", "point", "", "a uniform force"},
      {"potential", "expression", "expression", "string", "", "V in x and y"},
      {"potential", "expression", "parameters", "table", "", "names in it and their numbers"},
      {"potential", "", "center", "point", "",
       "where it is; the origin if neither center nor centers is given"},
      {"potential", "", "centers", "list of points", "", "several places"},
      {"potential", "", "lattice", "boolean", "false",
       "true: repeated on the lattice (fermi and gaussian)"},

      {"interaction", "", "kind", "string", "",
       "coulomb, yukawa, lennard-jones, soft-sphere, hard-discs or expression"},
      {"interaction", "coulomb|yukawa|soft-sphere", "strength", "number", "1",
       "factor of the energy"},
      {"interaction", "yukawa", "range", "number", "", "length of the exponential decay"},
      {"interaction", "lennard-jones", "depth", "number", "1", "of the well"},
      {"interaction", "lennard-jones|soft-sphere", "diameter", "number", "", "length scale"},
      {"interaction", "soft-sphere", "exponent", "whole number", "12", "the power of diameter/r"},
      {"interaction", "hard-discs", "radius", "number", "", "of every disc"},
      {"interaction", "hard-discs", "radii", "list of numbers", "",
       "a radius for each particle, instead of radius"},
      {"interaction", "expression", "expression", "string", "", "W in r"},
      {"interaction", "expression", "parameters", "table", "", "names in it and their numbers"},

      {"integrator", "", "scheme", "string", "\"blanes-moan-srkn11b\"",
       "name of a scheme, arkode or cvode"},
      {"integrator", "", "step", "number", "",
       "time of a step; if forces act and none is given, the program chooses one; for arkode and "
       "cvode the longest step"},
      {"integrator", "", "step_chosen", "boolean", "",
       "true: the program chose the step; written into resolved systems"},
      {"integrator", "", "tolerance", "number", "",
       "for arkode and cvode: error of a step, relative to the state; 1e-12 if not given"},
      {"integrator", "", "unresolved", "string", "",
       "a step that does not resolve the forces: stop ends the trajectory as unresolved, count "
       "counts the step and continues, halve divides it into parts that resolve them; default: "
       "halve if the program chooses the step, else stop"},
      {"integrator", "", "energy_tolerance", "number", "1e-3",
       "largest change of the energy, relative to the largest kinetic energy, that a result may "
       "have; beyond it the report begins with a warning and the exit status is 3"},

      {"run", "", "t_max", "number", "1000", "when a trajectory stops"},
      {"run", "", "collisions", "whole number", "",
       "largest number of hits of a trajectory; no limit if not given"},
      {"run", "", "trajectories", "whole number", "100000",
       "size of an ensemble; default for listed starts (point, list, file, birkhoff) if nothing is "
       "drawn at random: their number"},
      {"run", "", "seed", "whole number", "1", "of the random numbers"},
      {"run", "", "trust_tolerance", "number", "1e-3",
       "largest error of a trusted collision of `carom run`, relative to the table's size"},
      {"run", "", "sample", "number", "", "time between samples; none if not given"},
      {"run", "", "times", "list or table", "",
       "when survival is reported; {from = t_max/1000, to = t_max, count = 31, spacing = \"log\"} "
       "if not "
       "given"},
      {"run", "", "window", "list of two numbers", "",
       "times between which a decay is fitted, or report times between which the diffusion "
       "coefficient is measured; chosen if not given"},
      {"run", "", "free_paths", "true or false", "",
       "carom diffusion: true counts the lengths of flights; false if not given"},
      {"run", "", "spectrum", "true or false", "",
       "carom lyapunov: true computes all exponents of all particles together; false if not given"},
      {"run.times", "", "from", "number", "", "the first time"},
      {"run.times", "", "to", "number", "", "the last time, at most t_max"},
      {"run.times", "", "count", "whole number", "31", "number of times, from 2 to 100000"},
      {"run.times", "", "spacing", "string", "\"log\"", "log or linear"},

      {"section", "", "on", "string", "\"boundary\"",
       "surface of `carom section`: boundary, wall:NAME, line:x0,y0:x1,y1, segment:x0,y0:x1,y1, "
       "circle:x,y,r, x=c, y=c, vx=c or vy=c"},
      {"section", "", "direction", "string", "\"both\"",
       "crossings that count: both, positive (to the left of a line, out of a circle, growing "
       "coordinate) or "
       "negative"},
      {"section", "", "points", "whole number", "1000", "largest number of points of an orbit"},
      {"section", "", "orbits", "whole number", "",
       "number of orbits; if not given, one for each listed start, else trajectories, but at most "
       "50"},
  };
  return keys;
}

std::string key_table_markdown() {
  // There may be several of these, each under [[its name]].
  const auto heading = [](std::string_view section) {
    const bool list = section == "table.obstacle" || section == "table.hole" ||
                      section == "table.wall" || section == "table.region" ||
                      section == "table.loop" || section == "injection" || section == "potential";
    return list ? fmt::format("[[{}]]", section) : std::string(section);
  };
  std::string page;
  std::string_view section = "none";
  for (const KeyDescription& key : key_table()) {
    if (key.section != section) {
      section = key.section;
      page += section.empty() ? "### Above all sections\n\n"
                              : fmt::format("\n### {}\n\n", heading(section));
      page += "| key | for | type | default | meaning |\n|---|---|---|---|---|\n";
    }
    std::string kinds(key.kind);
    for (std::size_t at = 0; (at = kinds.find('|', at)) != std::string::npos;)
      kinds.replace(at, 1, ", ");
    const std::string fallback = key.fallback.empty() ? "" : fmt::format("`{}`", key.fallback);
    page += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.key, kinds, key.type, fallback,
                        key.meaning);
  }
  return page;
}

}  // namespace carom
