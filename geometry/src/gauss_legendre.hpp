// Integrals by Gauss and Legendre with 8 points.
#pragma once

namespace carom::geometry {

double gauss_legendre(double from, double to, const auto& f) {
  constexpr double node[4] = {0.18343464249564980494, 0.52553240991632898582,
                              0.79666647741362673959, 0.96028985649753623168};
  constexpr double weight[4] = {0.36268378337836198297, 0.31370664587788728734,
                                0.22238103445337447054, 0.10122853629037625915};
  const double half = 0.5 * (to - from), middle = from + half;
  double sum = 0.0;
  for (int i = 3; i >= 0; --i)
    sum += weight[i] * (f(middle - half * node[i]) + f(middle + half * node[i]));
  return half * sum;
}

}  // namespace carom::geometry
