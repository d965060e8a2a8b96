#include "certify/tie.hpp"

#include "certify/tie_follower.hpp"

namespace carom::certify {

class TieFinder::Implementation {
 public:
  Implementation(const ExactSystem& system, const CertifiedTask& task) : system_(system), task_(task) {}

  std::optional<Tie> find(const std::vector<Copy>& path, const Doubt& doubt) {
    if (hopeless_) return std::nullopt;
    obstacle_.clear();
    const QuadraticField field;
    QuadraticField::radicand() = radicand_;
    try {
      if (!follower_) follower_.emplace(system_, task_);
      for (; followed_ < path.size(); ++followed_) follower_->fly_to(path[followed_]);
    } catch (const NotQuadratic& reason) {
      hopeless_ = true;
      obstacle_ = reason.what();
      return std::nullopt;
    }
    radicand_ = QuadraticField::radicand();
    try {
      TieFollower there = *follower_;
      std::optional<Tie> tie = there.tie(doubt);
      if (tie) tie->text = "event " + std::to_string(path.size() + 1) + ": " + tie->text;
      return tie;
    } catch (const NotQuadratic& reason) {
      obstacle_ = reason.what();
      return std::nullopt;
    }
  }
  const std::string& obstacle() const { return obstacle_; }

 private:
  const ExactSystem& system_;
  const CertifiedTask& task_;
  std::optional<TieFollower> follower_;
  std::size_t followed_ = 0;
  mpz_class radicand_;
  bool hopeless_ = false;
  std::string obstacle_;
};

TieFinder::TieFinder(const ExactSystem& system, const CertifiedTask& task)
    : implementation_(std::make_unique<Implementation>(system, task)) {}
TieFinder::~TieFinder() = default;
std::optional<Tie> TieFinder::find(const std::vector<Copy>& path, const Doubt& doubt) {
  return implementation_->find(path, doubt);
}
const std::string& TieFinder::obstacle() const { return implementation_->obstacle(); }

}  // namespace carom::certify
