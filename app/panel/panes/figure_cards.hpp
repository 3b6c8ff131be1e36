// SPDX-License-Identifier: BSD-3-Clause
// The figures of the run shown, as the command line draws them, in the size of a pane.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/panel/runs/simulator.hpp"
#include "app/panel/runs/study_job.hpp"
#include "app/panel/runs/trade.hpp"
#include "render/plot/figures.hpp"
#include "render/plot/layout.hpp"

namespace unfurl {

// The figure of the present run with the curves of a pinned one behind it, dashed.
Figure with_pinned(Figure present, const Figure& pinned);

struct FigureCard {
  const FigureKind* kind = nullptr;
  bool open = false;
  // Made when they are looked at.
  std::unique_ptr<Figure> figure;  // at a fixed address: the layout points into it
  plot::FigureLayout layout;
};

// Of figures at scale 1: small text has 10.5 pixels.
inline constexpr double figure_pixels_per_point = 1.5;

class FigureCards {
 public:
  FigureCards();

  std::vector<FigureCard>& cards() { return cards_; }
  // Speed against accuracy: of every run so far. Its figure is made again where `news`
  // (PanelState::trade_news) or the study is new.
  FigureCard& trade() { return trade_; }
  void make_trade(const std::vector<TradePoint>& points, long news,
                  const std::shared_ptr<const StudyOutcome>& studied);
  // Call each frame: forgets figures of other runs and of other widths. `width`: of the pane [points].
  void show(const std::shared_ptr<const LiveRun>& run, const std::shared_ptr<const LiveRun>& pinned,
            double width);
  // The figures of a study, laid out for a pane of that width [points]; with the present run where the study
  // is of its motion.
  std::vector<FigureCard*> study(const std::shared_ptr<const StudyOutcome>& outcome,
                                 const std::vector<TradePoint>& points, long news, double width);
  bool applies(const FigureCard& card) const;
  void make(FigureCard& card) const;  // figure and layout, where they are missing

 private:
  static void place(FigureCard& card, Figure figure, double width);  // lays it out for the pane

  std::vector<FigureCard> cards_;
  FigureCard trade_;
  std::shared_ptr<const LiveRun> run_, pinned_;
  double width_ = 0;
  long trade_news_ = 0;
  std::shared_ptr<const StudyOutcome> trade_study_;  // that the trade's figure knows
  std::shared_ptr<const StudyOutcome> studied_;
  std::vector<FigureCard> study_cards_;
  double study_width_ = 0;
  long study_news_ = 0;
};

}  // namespace unfurl
