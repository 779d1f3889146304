// clip.js: the half space that is not drawn.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Clip } from '../../client/view/web/clip.js';

test('without a plane nothing is hidden', () => {
  const clip = new Clip();
  assert.ok(!clip.hides(1e9, -1e9, 1e9));
  clip.set(0, 0, 1);
  clip.set(-1, 0, 1);
  assert.ok(!clip.hides(1e9, -1e9, 1e9));
});

test('what lies beyond the plane is hidden, on the side that is asked for, and not what lies on it', () => {
  const at = (axis, c) => [9, 9, 9].map((other, i) => (i === axis ? c : other));
  for (const axis of [0, 1, 2]) {
    const clip = new Clip();
    clip.set(axis, 0.25, 1);
    assert.deepEqual([0, 0.25, 0.5].map((c) => clip.hides(...at(axis, c))), [false, false, true]);
    clip.set(axis, 0.25, -1);
    assert.deepEqual([0, 0.25, 0.5].map((c) => clip.hides(...at(axis, c))), [true, false, false]);
    clip.set(axis, -0.5, -1);
    assert.deepEqual([-1, -0.5, 0].map((c) => clip.hides(...at(axis, c))), [true, false, false]);
  }
});

test('the plane of the shaders is the same', () => {
  const clip = new Clip();
  const { uniform } = clip;
  clip.set(1, 0.25, -1);
  assert.deepEqual(uniform.value.toArray().map((c) => c + 0), [0, -1, 0, -0.25]);
});
