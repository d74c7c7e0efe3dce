// Moves, pushes or measures the islands of a block, one vector after another: included after
// contact_lanes_inl.hpp.

constexpr float kReach = 1.25f;       // contacts are looked for in so many times the closing way
constexpr float kReachSpare = 1e-4f;  // m

void put_results(IslandLanes& l, F deepest) {
  store(deepest, l.b.deepest, l.o);
  store(l.work, l.b.work.v + l.o);
  store(l.undone, l.b.undone.v + l.o);
}

// Substeps: free flight until something may touch, then contacts; short enough that contact points
// stay accurate, so as a rule overlaps stay below kSlop. The rest is pushed apart, and what cannot
// be helped is put back to where it was before the substep: that is what keeps overlaps within
// kOverlapLimit at any density and speed. It ends, as poses before the substep were good.
void run_vector(Block& block, std::size_t first) {
  IslandLanes l(block, first);
  ContactLanes contacts(l);
  const F span = load(block.span, first);
  const Whole most_work = load_whole(block.most_work, first);
  l.begin();
  F deepest = l.survey();
  const Mask deep = l.used & (deepest > kSlop);
  if (any(deep)) deepest = l.keep_good(deepest, deepest, deep), l.accept(deep);
  F left = keep(l.used, span);
  for (;;) {
    const Mask idle = l.work > most_work;
    const Mask going = (left > 0.0f) & ~idle;
    if (!any(going)) break;
    const IslandLanes::Limits limits = l.limits(left);
    const F parts = floor(left / greater(limits.longest, kTiny)) + 1.0f;
    const F part = choose(limits.longest < left, left / parts, left);
    const Mask free = limits.free_time >= part;
    const F step = keep(going, choose(free, lesser(limits.free_time, left), part));
    const F margin = kReach * limits.fastest * step + kReachSpare;
    Mask met = going & ~free;
    if (any(met)) met = contacts.approach(margin, step, met);
    if (any(met)) l.mark_touched(met);  // a rebound can restore the twist, but not the way
    l.move(step, going);
    if (any(met)) contacts.rebound(step, met);
    left = choose(going, keep(step < left, left - step), left);
    const F now = l.survey();
    deepest = choose(going, l.keep_good(now, deepest, going), deepest);
    l.accept(going);
  }
  put_results(l, deepest);
}

void push_vector(Block& block, std::size_t first, int rounds) {
  IslandLanes l(block, first);
  put_results(l, l.push_apart(rounds, l.used));
}

void survey_vector(Block& block, std::size_t first) {
  IslandLanes l(block, first);
  put_results(l, l.survey());
}

template <class Use>
HWY_INLINE void each_vector(const Block& block, Use&& use) {
  const auto lanes = width();
  for (std::size_t i = 0; i < static_cast<std::size_t>(block.count); i += lanes) use(i);
}

void run(Block& block) {
  each_vector(block, [&](std::size_t first) { run_vector(block, first); });
}
[[maybe_unused]] void push(Block& block, int rounds) {
  each_vector(block, [&](std::size_t first) { push_vector(block, first, rounds); });
}
[[maybe_unused]] void survey(Block& block) {
  each_vector(block, [&](std::size_t first) { survey_vector(block, first); });
}
