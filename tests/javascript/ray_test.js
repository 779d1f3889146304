// ray.js: where a ray meets triangles.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { firstHit } from '../../client/view/web/ray.js';

// Two right triangles with legs along x and y, at z = 0 and z = 1.
const kPositions = Float32Array.from([0, 0, 0, 4, 0, 0, 0, 4, 0, 0, 0, 1, 4, 0, 1, 0, 4, 1]);
const kCorners = Uint16Array.from([0, 1, 2, 3, 4, 5]);
const never = () => false;
const down = (x, y) => ({ origin: { x, y, z: 3 }, along: { x: 0, y: 0, z: -1 } });

test('the nearest triangle is met, with the weights of its corners', () => {
  const hit = firstHit(kPositions, kCorners, 6, down(1, 2), never);
  assert.deepEqual(hit, { depth: 2, place: [1, 2, 1], triangle: 1, vertices: [3, 4, 5], weights: [0.25, 0.25, 0.5] });
});

test('the order of the triangles is none of its matter', () => {
  const hit = firstHit(kPositions, Uint16Array.from([3, 4, 5, 0, 1, 2]), 6, down(1, 2), never);
  assert.deepEqual(hit.vertices, [3, 4, 5]);
});

test('only the first corners count', () => {
  assert.deepEqual(firstHit(kPositions, kCorners, 3, down(1, 2), never).vertices, [0, 1, 2]);
  assert.equal(firstHit(kPositions, kCorners, 0, down(1, 2), never), null);
});

test('what is skipped is not there', () => {
  const hit = firstHit(kPositions, kCorners, 6, down(1, 2), (x, y, z) => z > 0.5);
  assert.deepEqual(hit.place, [1, 2, 0]);
  assert.equal(firstHit(kPositions, kCorners, 6, down(1, 2), () => true), null);
});

test('a ray beside all triangles, or in their plane, meets none', () => {
  for (const [x, y] of [[-0.1, 1], [1, -0.1], [3, 2]]) {
    assert.equal(firstHit(kPositions, kCorners, 6, down(x, y), never), null, `${x}, ${y}`);
  }
  const level = { origin: { x: -1, y: 1, z: 0 }, along: { x: 1, y: 0, z: 0 } };
  assert.equal(firstHit(kPositions, kCorners, 6, level, never), null);
});

test('a slanting ray, from the back of the triangles', () => {
  const ray = { origin: { x: 0, y: 1, z: -1 }, along: { x: Math.SQRT1_2, y: 0, z: Math.SQRT1_2 } };
  const hit = firstHit(kPositions, kCorners, 6, ray, never);
  assert.deepEqual(hit.vertices, [0, 1, 2]);
  hit.place.forEach((c, i) => assert.ok(Math.abs(c - [1, 1, 0][i]) < 1e-12));
});
