#include "orbits/itinerary.hpp"

#include <gsl/gsl_multimin.h>

#include <memory>
#include <vector>

namespace carom::orbits {

namespace {

// The length of a chain by how far its hits were moved from where they began, each on its wall.
struct Length {
  const Boundary& boundary;
  const Chain& start;

  Chain moved(const gsl_vector* by) const {
    Chain chain = start;
    bool left_wall = false;
    for (std::size_t i = 0; i < chain.size(); ++i)
      chain[i].u =
          moved_along(boundary, {chain[i].wall, chain[i].u}, gsl_vector_get(by, i), left_wall).u;
    return chain;
  }
};

double value(const gsl_vector* by, void* of) {
  const auto& length = *static_cast<const Length*>(of);
  const Chain chain = length.moved(by);
  return length_of(length.boundary, chain, geometry_of(length.boundary, chain));
}

// moved_along() goes along the tangent at the start and back to the wall along a ray: a step there
// is one along the wall times the cosine of the angle between both, over the ray's stretch, which
// is that cosine again on a circle.
void slope(const gsl_vector* by, void* of, gsl_vector* out) {
  const auto& length = *static_cast<const Length*>(of);
  const Chain chain = length.moved(by);
  const ChainGeometry g = geometry_of(length.boundary, chain);
  const std::vector<double> sides = residual(length.boundary, g);
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const Link& from = length.start[i];
    const double cosine =
        dot(wall_point(length.boundary, from.wall, from.u).tangent, g.points[i].tangent);
    gsl_vector_set(out, i, sides[i] * cosine * cosine);
  }
}

void both(const gsl_vector* by, void* of, double* at, gsl_vector* out) {
  *at = value(by, of);
  slope(by, of, out);
}

}  // namespace

Chain shortest(const Boundary& boundary, const Chain& chain) {
  const std::size_t n = chain.size();
  Length length{boundary, chain};
  gsl_multimin_function_fdf function{&value, &slope, &both, n, &length};
  const std::unique_ptr<gsl_vector, void (*)(gsl_vector*)> start(gsl_vector_calloc(n),
                                                                 gsl_vector_free);
  const std::unique_ptr<gsl_multimin_fdfminimizer, void (*)(gsl_multimin_fdfminimizer*)> minimizer(
      gsl_multimin_fdfminimizer_alloc(gsl_multimin_fdfminimizer_vector_bfgs2, n),
      gsl_multimin_fdfminimizer_free);
  const double step = 0.1 * geometry_of(boundary, chain).shortest;
  gsl_multimin_fdfminimizer_set(minimizer.get(), &function, start.get(), step, 0.1);
  // Newton's method ends what is left: half the digits are enough.
  for (int i = 0; i < 200 && gsl_multimin_fdfminimizer_iterate(minimizer.get()) == 0; ++i)
    if (gsl_multimin_test_gradient(minimizer->gradient, 0x1p-26) == 0) break;
  return length.moved(minimizer->x);
}

}  // namespace carom::orbits
