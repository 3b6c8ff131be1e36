// SPDX-License-Identifier: BSD-3-Clause
#include "render/ui/draw_damage.hpp"

#include <algorithm>
#include <cmath>

namespace unfurl {

namespace {

void append(std::vector<std::byte>& bytes, const void* data, std::size_t size) {
  const auto* from = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), from, from + size);
}

plot::Rect joined(const plot::Rect& a, const plot::Rect& b) {
  return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

plot::Rect common(const plot::Rect& a, const plot::Rect& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

double area(const plot::Rect& r) {
  return r.width() * r.height();
}

bool empty(const plot::Rect& r) {
  return !(r.x1 > r.x0) || !(r.y1 > r.y0);
}

}  // namespace

std::vector<plot::Rect> apart(std::vector<plot::Rect> rects) {
  constexpr double hardly = 1.1;  // times what they cover
  std::erase_if(rects, empty);
  const plot::Rect last = rects.empty() ? plot::Rect() : rects.back();
  std::vector<plot::Rect> out;
  while (!rects.empty()) {
    const plot::Rect one = rects.back();
    rects.pop_back();
    const auto touched =
        std::find_if(out.begin(), out.end(), [&](const plot::Rect& r) { return r.overlaps(one); });
    if (touched == out.end()) {
      out.push_back(one);
      continue;
    }
    const plot::Rect both = joined(one, *touched), shared = common(one, *touched);
    if (area(both) <= hardly * (area(one) + area(*touched) - area(shared))) {
      out.erase(touched);  // the larger one may overlap others
      rects.push_back(both);
      continue;
    }
    const bool stays = one.contains(last);
    const plot::Rect cut = stays ? *touched : one;
    if (stays) out.erase(touched);
    for (const plot::Rect& rest : {plot::Rect{cut.x0, cut.y0, cut.x1, shared.y0},  // above
                                   plot::Rect{cut.x0, shared.y1, cut.x1, cut.y1},  // below
                                   plot::Rect{cut.x0, shared.y0, shared.x0, shared.y1},
                                   plot::Rect{shared.x1, shared.y0, cut.x1, shared.y1}})
      if (!empty(rest)) rects.push_back(rest);
    if (stays) rects.push_back(one);
  }
  return out;
}

DrawDamage::Seen DrawDamage::seen(const ImDrawList& list, const ImDrawData& data) {
  Seen now;
  now.name = list._OwnerName != nullptr ? list._OwnerName : "";
  const auto vertices = static_cast<std::size_t>(list.VtxBuffer.size_in_bytes());
  const auto indices = static_cast<std::size_t>(list.IdxBuffer.size_in_bytes());
  now.content.reserve(vertices + indices + 64 * static_cast<std::size_t>(list.CmdBuffer.Size));
  append(now.content, list.VtxBuffer.Data, vertices);
  append(now.content, list.IdxBuffer.Data, indices);
  plot::Rect shown{1e9, 1e9, -1e9, -1e9};
  for (const ImDrawCmd& c : list.CmdBuffer) {
    append(now.content, &c.ClipRect, sizeof c.ClipRect);
    append(now.content, &c.TextureId, sizeof c.TextureId);
    append(now.content, &c.ElemCount, sizeof c.ElemCount);
    if (c.ElemCount > 0) shown = joined(shown, {c.ClipRect.x, c.ClipRect.y, c.ClipRect.z, c.ClipRect.w});
  }
  plot::Rect drawn{1e9, 1e9, -1e9, -1e9};
  for (const ImDrawVert& v : list.VtxBuffer) drawn = joined(drawn, {v.pos.x, v.pos.y, v.pos.x, v.pos.y});
  const plot::Rect r = common(common(shown, drawn.grown(1)), {0, 0, data.DisplaySize.x, data.DisplaySize.y});
  now.bounds = {std::floor(r.x0), std::floor(r.y0), std::ceil(r.x1), std::ceil(r.y1)};
  return now;
}

std::vector<plot::Rect> DrawDamage::update(const ImDrawData& data) {
  std::vector<Seen> now;
  for (int i = 0; i < data.CmdListsCount; ++i) now.push_back(seen(*data.CmdLists[i], data));
  std::vector<plot::Rect> damage;
  bool known = known_ && width_ == data.DisplaySize.x && height_ == data.DisplaySize.y;
  std::size_t next = 0;  // old lists before it were looked at
  for (const Seen& list : now) {
    const auto same = [&](const Seen& old) { return old.name == list.name; };
    const auto begin = lists_.begin() + static_cast<std::ptrdiff_t>(next);
    const auto old = std::find_if(begin, lists_.end(), same);
    if (old == lists_.end()) {
      known = known && std::none_of(lists_.begin(), begin, same);  // else it went below another
      damage.push_back(list.bounds);
      continue;
    }
    for (auto gone = begin; gone != old; ++gone) damage.push_back(gone->bounds);
    next = static_cast<std::size_t>(old - lists_.begin()) + 1;
    if (old->content == list.content) continue;
    damage.push_back(old->bounds);
    damage.push_back(list.bounds);
  }
  for (; next < lists_.size(); ++next) damage.push_back(lists_[next].bounds);
  if (!known) damage = {{0, 0, data.DisplaySize.x, data.DisplaySize.y}};
  known_ = true;
  lists_ = std::move(now);
  width_ = data.DisplaySize.x;
  height_ = data.DisplaySize.y;
  return apart(std::move(damage));
}

}  // namespace unfurl
