// SPDX-License-Identifier: BSD-3-Clause
#include "app/panel/panes/figure_cards.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "render/plot/style.hpp"

namespace unfurl {

namespace {

// Side by side is for a page; a pane has its panels below each other.
void stack(Figure& figure, double width) {
  const bool poses = std::any_of(figure.panels.begin(), figure.panels.end(),
                                 [](const Panel& panel) { return !panel.segments.empty(); });
  const double page = figure.width_mm;
  figure.width_mm = width / plot::points_per_mm;
  if (poses) {
    figure.height_mm *= figure.width_mm / page;
    return;
  }
  const double row = figure.height_mm / figure.rows;
  figure.rows = static_cast<int>(figure.panels.size());
  figure.columns = 1;
  std::size_t labels = 0;  // a legend of many rows must leave room for the curves
  for (const Panel& panel : figure.panels)
    labels = std::max(labels, static_cast<std::size_t>(
                                  std::count_if(panel.curves.begin(), panel.curves.end(),
                                                [](const Curve& curve) { return !curve.label.empty(); })));
  const double share = labels > 5 ? 0.85 : 0.55;
  figure.height_mm = figure.rows * std::min(row, share * figure.width_mm) + 6;
}

}  // namespace

Figure with_pinned(Figure present, const Figure& pinned) {
  // A panel of the same quantities, in the order in which they come: the runs may have others before it.
  std::vector<bool> taken(pinned.panels.size(), false);
  for (Panel& panel : present.panels) {
    std::size_t i = 0;
    while (i < pinned.panels.size() && (taken[i] || pinned.panels[i].x.label != panel.x.label ||
                                        pinned.panels[i].y.label != panel.y.label))
      ++i;
    if (i == pinned.panels.size()) continue;
    taken[i] = true;
    auto& curves = panel.curves;
    std::vector<Curve> all;
    for (Curve curve : pinned.panels[i].curves) {
      curve.label.clear();
      curve.dash = Dash::dashed;
      curve.marker = Marker::none;
      curve.width = 0.9f;
      all.push_back(std::move(curve));
    }
    all.insert(all.end(), curves.begin(), curves.end());
    curves = std::move(all);
  }
  return present;
}

// A designer's first: what the structure bears and how it deploys, then how well that was computed. What is
// not named here follows in the table's order.
FigureCards::FigureCards() {
  constexpr std::string_view first[] = {"rod_forces", "drives",     "rod_strength",
                                        "margin",     "deployment", "energy"};
  const auto rank = [&](const FigureCard& card) {
    return std::find(std::begin(first), std::end(first), card.kind->name) - std::begin(first);
  };
  for (const FigureKind& kind : figure_kinds()) cards_.push_back({&kind, false, nullptr, {}});
  std::stable_sort(cards_.begin(), cards_.end(),
                   [&](const FigureCard& a, const FigureCard& b) { return rank(a) < rank(b); });
}

void FigureCards::show(const std::shared_ptr<const LiveRun>& run,
                       const std::shared_ptr<const LiveRun>& pinned, double width) {
  if (run == run_ && pinned == pinned_ && width == width_) return;
  run_ = run;
  pinned_ = pinned;
  width_ = width;
  for (FigureCard& card : cards_) card.figure.reset();
  trade_.figure.reset();
}

bool FigureCards::applies(const FigureCard& card) const {
  return run_ && card.kind->applies(run_->simulation, run_->diagnostics);
}

void FigureCards::make(FigureCard& card) const {
  if (card.figure) return;
  Figure figure = card.kind->make(run_->simulation, run_->diagnostics);
  if (pinned_ && pinned_ != run_ && card.kind->applies(pinned_->simulation, pinned_->diagnostics))
    figure = with_pinned(std::move(figure), card.kind->make(pinned_->simulation, pinned_->diagnostics));
  place(card, std::move(figure), width_);
}

void FigureCards::make_trade(const std::vector<TradePoint>& points, long news,
                             const std::shared_ptr<const StudyOutcome>& studied) {
  if (trade_.figure && news == trade_news_ && studied == trade_study_) return;
  trade_news_ = news;
  trade_study_ = studied;
  const bool same = studied && !points.empty() && same_motion(studied->motion, points.back().motion);
  place(trade_, trade_figure(points, same ? studied->study.get() : nullptr), width_);
}

std::vector<FigureCard*> FigureCards::study(const std::shared_ptr<const StudyOutcome>& outcome,
                                            const std::vector<TradePoint>& points, long news, double width) {
  if (outcome != studied_ || width != study_width_ || news != study_news_) {
    studied_ = outcome;
    study_width_ = width;
    study_news_ = news;
    study_cards_.clear();
    const bool same = outcome->study && !points.empty() && same_motion(outcome->motion, points.back().motion);
    for (const Figure& figure : outcome->figures) {
      study_cards_.emplace_back();
      place(study_cards_.back(), same ? with_present(figure, points) : figure, width);
    }
  }
  std::vector<FigureCard*> all;
  for (FigureCard& card : study_cards_) all.push_back(&card);
  return all;
}

void FigureCards::place(FigureCard& card, Figure figure, double width) {
  stack(figure, width);
  card.figure = std::make_unique<Figure>(std::move(figure));
  plot::LayoutOptions options;
  options.title = options.caption = false;
  card.layout = plot::lay_out(*card.figure, options);
}

}  // namespace unfurl
