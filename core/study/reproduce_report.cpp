// SPDX-License-Identifier: BSD-3-Clause
#include "core/study/reproduce_report.hpp"

namespace unfurl {
namespace {

void introduce(Report& report) {
  report.paragraph(
      "The paper is Kong, Ma, Xue, Ding, *Dynamic simulation of deployable structures based on discrete "
      "variational "
      "method* (2023). It folds up a ring antenna of six units, rigid rods on frictionless joints, lets "
      "forces on its "
      "hinges open it, and compares two ways of computing the motion: a **discrete variational method**, "
      "which makes "
      "the action of the motion stationary and keeps every rod's length, and the classical **Runge-Kutta** "
      "method of "
      "order 4 on the differentiated equations, which lets lengths drift. This page is written by `unfurl "
      "reproduce`, "
      "which runs both again and puts its numbers beside the printed ones.");
  report.paragraph(
      "Two errors appear here, and they are different things. The **constraint error** says how far the rods "
      "are from "
      "their lengths; it can be read off any run. The **trajectory error** says how far the nodes are from "
      "where they "
      "should be at that time; it needs a reference.");
}

void assume(Report& report) {
  report.heading("What was assumed, and why");
  report.paragraph(
      "The text of the paper leaves some things open; each was read in the one way that makes sense "
      "physically and agrees with its numbers.");
  report.add(
      {{"the paper", "read as", "because"},
       {{"initial fold angle: not given", "89.34053637766085 degrees",
         "with the ring below, conservation of energy makes the printed deployment time of 4.92 s belong to "
         "exactly "
         "this angle"},
        {"geometry: in figures only",
         "six units share six posts; chords of 3 m hinged in the middle of each side, "
         "posts of 1.2 m; folded, bottom hinges stand above the bottom ring and top hinges hang below the "
         "top ring",
         "negative Poisson's ratio: the forces pull the hinges apart until the chords are straight"},
        {"eq. 9: 19 entries for 18 coordinates", "-f on each bottom hinge, +f on each top hinge, f = 200 N",
         "the only assignment that opens a unit without moving it"},
        {"rods 12, 23, 34, 41, 56, 67", "12, 23, 34, 45, 56, 61", "misprint: a loop of six nodes"},
        {"\"center of gravity interpolation\"", "barycentric (Lagrange) interpolation", "its formula"},
        {"number of interpolation nodes: not given", "3, equidistant",
         "changes nothing: with multipliers at step ends only, the trajectory is the same to round-off for "
         "2, 3, 4 "
         "and 5 nodes"},
        {"constraint error: which norm is not said", "largest of all constraints, in metres",
         "the usual one"}}});
}

void compare(Report& report, const Reproduction& r, const ReproductionPictures& pictures) {
  report.heading("Tables 1 and 2 of the paper, beside ours");
  report.paragraph(
      "CPU times are of different machines and programs; what carries over is the ratio to Runge-Kutta. "
      "Ours are medians of five runs from 0 to " +
      short_number(r.end) +
      " s. The lower two rows "
      "are not in the paper.");
  report.add(reproduced_table(r, 0), "Step h = 0.01 s.");
  report.add(reproduced_table(r, 1), "Step h = 0.005 s.");
  report.paragraph(
      "The printed 2.2737e-13 is 2^-42, a power of two as rounding leaves it: it says that the iteration has "
      "converged, "
      "not how accurate the motion is. At half the step the paper's value grows to 4.7e-11, which suggests "
      "an iteration "
      "that stops at a fixed tolerance; here it goes on to round-off at every step. The constraint error of "
      "Runge-Kutta is somewhat larger here than printed "
      "(the ring is "
      "reconstructed) and falls by the same factor, 2^4, from one step to the other.");
  report.heading("Figure 2: the deployment");
  report.picture(pictures.poses, "Poses of the six-unit ring.");
  report.heading("Figures 3 and 4: constraint error");
  report.picture(pictures.constraint_error, "Constraint error of both methods over time, on the same axes.");
}

std::string same_cost(const Reproduction& r) {
  const MeasuredRun &ends = r.schemes[0].runs[paper_step].measured,
                    &four = r.schemes[3].runs[paper_step].measured;
  return "At h = 0.01 s the scheme as printed costs " + short_number(1e3 * ends.cpu_median) + " ms and is " +
         short_number(ends.position_error, 2) +
         " m off. With Lobatto nodes and constraints at every "
         "node, 4 nodes cost " +
         short_number(1e3 * four.cpu_median) + " ms and are " + short_number(four.position_error, 2) +
         " m off: " + short_number(ends.position_error / four.position_error, 2) + " times closer for " +
         short_number(four.cpu_median / ends.cpu_median, 2) + " times the cost.";
}

void judge(Report& report, const Reproduction& r, const ReproductionPictures& pictures) {
  report.heading("What the constraint error does not show");
  report.paragraph("The same runs, measured against a reference: " + r.reference +
                   ", whose last two solutions agree to " + short_number(r.reference_uncertainty) + " m.");
  report.picture(pictures.trajectory_error, "Trajectory error of the same runs.");
  report.add(trajectory_table(r), "Largest trajectory error in metres up to " + short_number(r.end) + " s.");
  report.paragraph(
      "The scheme as printed keeps the constraints to round-off and is nevertheless **second order**: "
      "between the "
      "ends of a step the constraints do not act, and the motion there is free flight, whatever the number "
      "of nodes. "
      "Runge-Kutta, whose constraint error looks a million times worse, follows the true motion much more "
      "closely at "
      "the same step. Constraints at every Lobatto node cure this: order 2 s - 2 with s nodes, "
      "with the constraint error still at round-off. " +
      same_cost(r));
}

void verify(Report& report, const Reproduction& r) {
  report.heading("Checks");
  Table table{{"claim", "found", "holds"}, {}};
  for (const Check& c : r.checks) table.rows.push_back({c.claim, c.found, c.holds ? "yes" : "NO"});
  report.add(std::move(table), "`unfurl reproduce` ends with exit code 7 where one of these does not hold.");
}

}  // namespace

Report reproduction_report(const Reproduction& r, const ReproductionPictures& pictures) {
  Report report{"A deployable ring antenna by the discrete variational method: the paper reproduced"};
  introduce(report);
  compare(report, r, pictures);
  judge(report, r, pictures);
  assume(report);
  verify(report, r);
  report.heading("Files");
  report.paragraph(
      "`runs.csv` holds every run with all digits, `figures/` the pictures as PNG and SVG. The scenes are "
      "`hoop6` and `hoop6_paper`: `unfurl render hoop6 -o out` draws the motion.");
  return report;
}

}  // namespace unfurl
