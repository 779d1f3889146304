// Neighbours on the lattice.  Points of an eroded solid can be seen when a neighbour is not in it.

// A hash table of lattice places, open addressing: the index of the point there, or -1.
class Places {
  constructor(steps) {
    this.steps = steps;
    const points = steps.length / 3;
    this.mask = 2 ** Math.ceil(Math.log2(2 * points + 1)) - 1;
    this.table = new Int32Array(this.mask + 1).fill(-1);
    for (let p = 0; p < points; ++p) {
      let slot = this.slot(steps[3 * p], steps[3 * p + 1], steps[3 * p + 2]);
      while (this.table[slot] >= 0) slot = (slot + 1) & this.mask;
      this.table[slot] = p;
    }
  }

  slot(i, j, k) {
    return (Math.imul(i, 73856093) ^ Math.imul(j, 19349663) ^ Math.imul(k, 83492791)) & this.mask;
  }

  at(i, j, k) {
    for (let slot = this.slot(i, j, k); ; slot = (slot + 1) & this.mask) {
      const p = this.table[slot];
      if (p < 0) return -1;
      if (this.steps[3 * p] === i && this.steps[3 * p + 1] === j && this.steps[3 * p + 2] === k) return p;
    }
  }
}

// All (a, b, c) of -1, 0 and 1, of which `nonzero` are not 0.
function offsets(nonzero) {
  const signs = [-1, 0, 1];
  const all = signs.flatMap((a) => signs.flatMap((b) => signs.map((c) => [a, b, c])));
  return all.filter((d) => d.filter((c) => c !== 0).length === nonzero);
}

// Which points a page holds for the eroded solid, one in `thinning` (see ViewSelection in
// client/view/view_points.h), and the offsets from one of them to the nearest others.
export function sublattice(thinning) {
  const stride = 2 ** Math.floor(Math.log2(thinning) / 3);
  const kind = thinning / stride ** 3; // 1 simple, 2 face-centred, 4 body-centred
  const even = (a, b, c) =>
    kind === 2 ? (a + b + c) % 2 === 0 : kind === 1 || (a % 2 === b % 2 && b % 2 === c % 2);
  return {
    holds: (i, j, k) =>
      i % stride === 0 && j % stride === 0 && k % stride === 0 && even(i / stride, j / stride, k / stride),
    neighbours: offsets({ 1: 1, 2: 2, 4: 3 }[kind]).map((d) => d.map((c) => c * stride)),
  };
}

// Per point the least share of v0 among its neighbours; -1 where a neighbour lies outside the body.
export function minAround(steps, shares, neighbours) {
  const places = new Places(steps);
  return shares.map((_, p) => {
    let least = Infinity;
    for (const [di, dj, dk] of neighbours) {
      const q = places.at(steps[3 * p] + di, steps[3 * p + 1] + dj, steps[3 * p + 2] + dk);
      least = Math.min(least, q < 0 ? -1 : shares[q]);
    }
    return least;
  });
}
