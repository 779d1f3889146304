// skeleton.js: what a sheet is where the pointer is.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { kindOf, weighted } from '../../client/view/web/skeleton.js';

test('a triangle or segment is what its vertices lead to', () => {
  const kinds = Int8Array.from([0, 1, 2, 3]);
  assert.equal(kindOf(kinds, [0, 0, 0]), 'ridge surface');
  assert.equal(kindOf(kinds, [0, 1]), 'ridge curve');
  assert.equal(kindOf(kinds, [0, 2, 0]), 'membrane');
  assert.equal(kindOf(kinds, [3, 0]), 'way');
});

test('sheets of chords are of one kind', () => {
  assert.equal(kindOf(new Int8Array(), [0, 1, 2]), '');
  assert.equal(kindOf(undefined, [0]), '');
});

test('values are weighted by nearness', () => {
  const hit = { vertices: [2, 0], weights: [0.75, 0.25], place: [0, 0, 0] };
  assert.equal(weighted([4, 100, 8], hit), 7);
  assert.equal(weighted([], hit), null);
});
