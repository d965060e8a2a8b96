#include "forces.hpp"

#include <algorithm>

namespace resolution {
namespace {

/// exp(-this) is nothing, for a summand of this height and width: its force is below 1e-29.
template <class Real>
Real exponent_of_nothing(const Term& term) {
  return Real(67) +
         logarithm(Real(1) + size(Real(term.height)) + size(Real(term.height)) / Real(term.width));
}

/// A summand in x and y whose derivatives are those of a function of one linear combination s = a x
/// + b y - c.
template <class Real>
class OnLine : public Force<Real> {
 public:
  explicit OnLine(const Term& t) : height_(t.height), width_(t.width), a_(t.a), b_(t.b), c_(t.c) {
    norm_ = root(a_ * a_ + b_ * b_);
  }

 protected:
  Real s_at(Real x, Real y) const { return a_ * x + b_ * y - c_; }
  void extend_s(int k, const Series<Real>& x, const Series<Real>& y) {
    s_[k] = a_ * x[k] + b_ * y[k];
    if (k == 0) s_[k] -= c_;
  }
  /// Adds -dV/ds times the gradient of s.
  void add(int k, Real pull, Series<Real>& ax, Series<Real>& ay) const {
    ax[k] += pull * a_;
    ay[k] += pull * b_;
  }

  Real height_, width_, a_, b_, c_, norm_;
  Series<Real> s_{};
};

template <class Real>
class Ridge : public OnLine<Real> {
 public:
  explicit Ridge(const Term& t) : OnLine<Real>(t), edge_(root(2 * exponent_of_nothing<Real>(t))) {}
  Real potential(Real x, Real y) const override {
    const Real q = this->s_at(x, y) / this->width_;
    return this->height_ * exponential(-q * q / 2);
  }
  Real lowest() const override { return std::min(Real(0), this->height_); }
  Limit<Real> limit(Real x, Real y) const override {
    const Real beyond = size(this->s_at(x, y)) - edge_ * this->width_;
    return {std::max(Real(0), beyond / this->norm_), this->width_ / this->norm_};
  }
  void extend(int k, const Series<Real>& x, const Series<Real>& y, Series<Real>& ax,
              Series<Real>& ay) override {
    this->extend_s(k, x, y);
    u_[k] = -square(this->s_, k) / (2 * this->width_ * this->width_);
    extend_exponential(e_, u_, k);
    this->add(k, this->height_ / (this->width_ * this->width_) * product(e_, this->s_, k), ax, ay);
  }

 private:
  Real edge_;
  Series<Real> u_{}, e_{};
};

template <class Real>
class SoftWall : public OnLine<Real> {
 public:
  explicit SoftWall(const Term& t) : OnLine<Real>(t), edge_(exponent_of_nothing<Real>(t)) {}
  Real potential(Real x, Real y) const override {
    return this->height_ * exponential(-this->s_at(x, y) / this->width_);
  }
  Real lowest() const override { return 0; }
  Limit<Real> limit(Real x, Real y) const override {
    const Real beyond = this->s_at(x, y) - edge_ * this->width_;
    return {std::max(Real(0), beyond / this->norm_), this->width_ / this->norm_};
  }
  void extend(int k, const Series<Real>& x, const Series<Real>& y, Series<Real>& ax,
              Series<Real>& ay) override {
    this->extend_s(k, x, y);
    u_[k] = -this->s_[k] / this->width_;
    extend_exponential(e_, u_, k);
    this->add(k, this->height_ / this->width_ * e_[k], ax, ay);
  }

 private:
  Real edge_;
  Series<Real> u_{}, e_{};
};

template <class Real>
class Edge : public OnLine<Real> {
 public:
  explicit Edge(const Term& t) : OnLine<Real>(t), edge_(exponent_of_nothing<Real>(t) / 2) {}
  Real potential(Real x, Real y) const override {
    const Real u = 2 * this->s_at(x, y) / this->width_;
    if (u < 0) return this->height_ / (1 + exponential(u));
    const Real e = exponential(-u);
    return this->height_ * e / (1 + e);
  }
  Real lowest() const override { return std::min(Real(0), this->height_); }
  Limit<Real> limit(Real x, Real y) const override {
    const Real beyond = size(this->s_at(x, y)) - edge_ * this->width_;
    return {std::max(Real(0), beyond / this->norm_), this->width_ / (2 * this->norm_)};
  }
  void extend(int k, const Series<Real>& x, const Series<Real>& y, Series<Real>& ax,
              Series<Real>& ay) override {
    this->extend_s(k, x, y);
    u_[k] = 2 * this->s_[k] / this->width_;
    extend_exponential(e_, u_, k);
    p_[k] = e_[k] + Real(k == 0 ? 1 : 0);
    extend_reciprocal(g_, p_, k);
    // -dV/ds = (2 height/width) g (1 - g), and g (1 - g) = g - g².
    this->add(k, 2 * this->height_ / this->width_ * (g_[k] - square(g_, k)), ax, ay);
  }

 private:
  Real edge_;
  Series<Real> u_{}, e_{}, p_{}, g_{};
};

template <class Real>
class Wave : public OnLine<Real> {
 public:
  using OnLine<Real>::OnLine;
  Real potential(Real x, Real y) const override { return this->height_ * cosine(this->s_at(x, y)); }
  Real lowest() const override { return -size(this->height_); }
  Limit<Real> limit(Real, Real) const override { return {Real(0), 1 / this->norm_}; }
  void extend(int k, const Series<Real>& x, const Series<Real>& y, Series<Real>& ax,
              Series<Real>& ay) override {
    this->extend_s(k, x, y);
    extend_sine(sine_, cosine_, this->s_, k);
    this->add(k, this->height_ * sine_[k], ax, ay);
  }

 private:
  Series<Real> sine_{}, cosine_{};
};

template <class Real>
class Linear : public OnLine<Real> {
 public:
  using OnLine<Real>::OnLine;
  Real potential(Real x, Real y) const override { return -this->s_at(x, y); }
  Real lowest() const override { return 0; }  // the orbit bounds it by the way
  Limit<Real> limit(Real, Real) const override { return {Real(0), Real(1e30L)}; }
  void extend(int k, const Series<Real>&, const Series<Real>&, Series<Real>& ax,
              Series<Real>& ay) override {
    if (k == 0) this->add(k, Real(1), ax, ay);
  }
};

template <class Real>
class Peaks : public Force<Real> {
 public:
  explicit Peaks(const Term& t) : height_(t.height), a_(t.a), b_(t.b), sharpness_(t.c) {}
  Real potential(Real x, Real y) const override {
    return height_ * exponential(sharpness_ * (cosine(a_ * x) + cosine(b_ * y) - 2));
  }
  Real lowest() const override { return std::min(Real(0), height_); }
  Limit<Real> limit(Real, Real) const override {
    return {Real(0), 1 / (std::max(a_, b_) * root(std::max(Real(1), sharpness_)))};
  }
  void extend(int k, const Series<Real>& x, const Series<Real>& y, Series<Real>& ax,
              Series<Real>& ay) override {
    px_[k] = a_ * x[k];
    py_[k] = b_ * y[k];
    extend_sine(sx_, cx_, px_, k);
    extend_sine(sy_, cy_, py_, k);
    u_[k] = sharpness_ * (cx_[k] + cy_[k] - Real(k == 0 ? 2 : 0));
    extend_exponential(e_, u_, k);
    ax[k] += height_ * sharpness_ * a_ * product(e_, sx_, k);
    ay[k] += height_ * sharpness_ * b_ * product(e_, sy_, k);
  }

 private:
  Real height_, a_, b_, sharpness_;
  Series<Real> px_{}, py_{}, sx_{}, cx_{}, sy_{}, cy_{}, u_{}, e_{};
};

/// A function of the distance from a point.
template <class Real>
class Centre {
 public:
  void place(Real x, Real y) {
    x_ = x;
    y_ = y;
  }
  void extend_square(int k, const Series<Real>& x, const Series<Real>& y) {
    dx_[k] = x[k] - (k == 0 ? x_ : Real(0));
    dy_[k] = y[k] - (k == 0 ? y_ : Real(0));
    square_[k] = square(dx_, k) + square(dy_, k);
  }
  void extend_bell(int k, Real height, Real width, Series<Real>& ax, Series<Real>& ay) {
    u_[k] = -square_[k] / (2 * width * width);
    extend_exponential(e_, u_, k);
    const Real factor = height / (width * width);
    ax[k] += factor * product(e_, dx_, k);
    ay[k] += factor * product(e_, dy_, k);
  }
  void extend_rational(int k, Real height, Real width, Series<Real>& ax, Series<Real>& ay) {
    u_[k] = square_[k] / (width * width) + Real(k == 0 ? 1 : 0);
    extend_reciprocal(g_, u_, k);
    e_[k] = square(g_, k);
    const Real factor = 2 * height / (width * width);
    ax[k] += factor * product(e_, dx_, k);
    ay[k] += factor * product(e_, dy_, k);
  }
  void extend_fermi(int k, Real height, Real radius, Real softness, Series<Real>& ax,
                    Series<Real>& ay) {
    extend_root(r_, square_, k);
    extend_reciprocal(inverse_, r_, k);
    u_[k] = (r_[k] - (k == 0 ? radius : Real(0))) / softness;
    extend_exponential(e_, u_, k);
    p_[k] = e_[k] + Real(k == 0 ? 1 : 0);
    extend_reciprocal(g_, p_, k);
    slope_[k] = g_[k] - square(g_, k);
    pull_[k] = product(slope_, inverse_, k);
    const Real factor = height / softness;
    ax[k] += factor * product(pull_, dx_, k);
    ay[k] += factor * product(pull_, dy_, k);
  }

 private:
  Real x_ = 0, y_ = 0;
  Series<Real> dx_{}, dy_{}, square_{}, u_{}, e_{}, g_{}, r_{}, inverse_{}, p_{}, slope_{}, pull_{};
};

template <class Real>
class Bump : public Force<Real> {
 public:
  explicit Bump(const Term& t)
      : rational_(t.shape == Term::Shape::rational),
        height_(t.height),
        width_(t.width),
        a_(t.a),
        b_(t.b) {
    edge_ = width_ * root(2 * exponent_of_nothing<Real>(t));
    centre_.place(a_, b_);
  }
  Real potential(Real x, Real y) const override {
    const Real q = ((x - a_) * (x - a_) + (y - b_) * (y - b_)) / (width_ * width_);
    return rational_ ? height_ / (1 + q) : height_ * exponential(-q / 2);
  }
  Real lowest() const override { return std::min(Real(0), height_); }
  Limit<Real> limit(Real x, Real y) const override {
    const Real square = (x - a_) * (x - a_) + (y - b_) * (y - b_);
    if (rational_) return {Real(0), Real(0.3L) * root(square + width_ * width_)};
    return {std::max(Real(0), root(square) - edge_), width_};
  }
  void extend(int k, const Series<Real>& x, const Series<Real>& y, Series<Real>& ax,
              Series<Real>& ay) override {
    centre_.extend_square(k, x, y);
    if (rational_)
      centre_.extend_rational(k, height_, width_, ax, ay);
    else
      centre_.extend_bell(k, height_, width_, ax, ay);
  }

 private:
  bool rational_;
  Real height_, width_, a_, b_, edge_;
  Centre<Real> centre_;
};

/// Copies of a bump at all points of a lattice.
template <class Real>
class Copies : public Force<Real> {
 public:
  Copies(const Term& t, const std::array<double, 4>& vectors)
      : fermi_(t.shape == Term::Shape::fermi), height_(t.height), width_(t.width), radius_(t.c) {
    for (std::size_t i = 0; i < 4; ++i) v_[i] = Real(vectors[i]);
    const Real nothing = exponent_of_nothing<Real>(t);
    edge_ = fermi_ ? radius_ + width_ * nothing : width_ * root(2 * nothing);
  }
  Real potential(Real x, Real y) const override {
    Real sum = 0;
    for_copies(x, y, edge_ + width_, [&](Real, Real, Real r) { sum += value(r); });
    return sum;
  }
  Real lowest() const override { return 0; }
  Limit<Real> limit(Real x, Real y) const override {
    const Real far = size(v_[0]) + size(v_[1]) + size(v_[2]) + size(v_[3]);
    Real nearest = far;
    for_copies(x, y, far, [&](Real, Real, Real r) { nearest = std::min(nearest, r); });
    // A Fermi bump has a tip at its centre: no step comes near it.
    const Real reach = fermi_ ? std::min(width_, nearest / 3) : width_;
    return {std::max(Real(0), nearest - edge_), reach};
  }
  void begin(Real x, Real y, Real way) override {
    used_ = 0;
    for_copies(x, y, edge_ + way, [&](Real cx, Real cy, Real) {
      if (used_ == centres_.size()) centres_.emplace_back();
      centres_[used_++].place(cx, cy);
    });
  }
  void extend(int k, const Series<Real>& x, const Series<Real>& y, Series<Real>& ax,
              Series<Real>& ay) override {
    for (std::size_t i = 0; i < used_; ++i) {
      centres_[i].extend_square(k, x, y);
      if (fermi_)
        centres_[i].extend_fermi(k, height_, radius_, width_, ax, ay);
      else
        centres_[i].extend_bell(k, height_, width_, ax, ay);
    }
  }

 private:
  Real value(Real r) const {
    if (!fermi_) return height_ * exponential(-r * r / (2 * width_ * width_));
    const Real u = (r - radius_) / width_;
    if (u < 0) return height_ / (1 + exponential(u));
    const Real e = exponential(-u);
    return height_ * e / (1 + e);
  }

  // All lattice points within `distance` of (x, y), each with its own distance.
  template <class Call>
  void for_copies(Real x, Real y, Real distance, Call call) const {
    const Real area = v_[0] * v_[3] - v_[1] * v_[2];
    const Real p = (x * v_[3] - y * v_[2]) / area, q = (y * v_[0] - x * v_[1]) / area;
    const Real dp = distance * root(v_[2] * v_[2] + v_[3] * v_[3]) / size(area);
    const Real dq = distance * root(v_[0] * v_[0] + v_[1] * v_[1]) / size(area);
    for (Real i = floor_of(p - dp); i <= p + dp; i += 1) {
      for (Real j = floor_of(q - dq); j <= q + dq; j += 1) {
        const Real cx = i * v_[0] + j * v_[2], cy = i * v_[1] + j * v_[3];
        const Real r = root((x - cx) * (x - cx) + (y - cy) * (y - cy));
        if (r <= distance) call(cx, cy, r);
      }
    }
  }

  bool fermi_;
  Real height_, width_, radius_, edge_;
  std::array<Real, 4> v_;
  std::vector<Centre<Real>> centres_;
  std::size_t used_ = 0;
};

}  // namespace

template <class Real>
std::vector<std::unique_ptr<Force<Real>>> forces_of(const System& system) {
  using Shape = Term::Shape;
  std::vector<std::unique_ptr<Force<Real>>> forces;
  for (const Term& term : system.terms) {
    switch (term.shape) {
      case Shape::gaussian:
      case Shape::rational:
        forces.push_back(std::make_unique<Bump<Real>>(term));
        break;
      case Shape::ridge:
        forces.push_back(std::make_unique<Ridge<Real>>(term));
        break;
      case Shape::soft_wall:
        forces.push_back(std::make_unique<SoftWall<Real>>(term));
        break;
      case Shape::edge:
        forces.push_back(std::make_unique<Edge<Real>>(term));
        break;
      case Shape::wave:
        forces.push_back(std::make_unique<Wave<Real>>(term));
        break;
      case Shape::peaks:
        forces.push_back(std::make_unique<Peaks<Real>>(term));
        break;
      case Shape::linear:
        forces.push_back(std::make_unique<Linear<Real>>(term));
        break;
      case Shape::fermi:
      case Shape::bells:
        forces.push_back(std::make_unique<Copies<Real>>(term, system.vectors));
        break;
    }
  }
  return forces;
}

template std::vector<std::unique_ptr<Force<Quad>>> forces_of(const System&);
template std::vector<std::unique_ptr<Force<long double>>> forces_of(const System&);

}  // namespace resolution
