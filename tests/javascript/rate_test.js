// rate.js: how fast jobs get on.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Rates } from '../../client/web/page/rate.js';

const jobAt = (done, id = 'a') => ({ id, directions_done: done, directions_total: 1000 });
const near = (value, expected) => assert.ok(Math.abs(value - expected) < 1e-9, `${value}, not ${expected}`);

test('nothing is known before there is progress', () => {
  const rates = new Rates();
  assert.equal(rates.of(jobAt(0)), null);
  assert.equal(rates.update(jobAt(0), 10), null);
  assert.equal(rates.update({ id: 'a', directions_total: 1000 }, 11), null);
});

test('the first pace is taken whole', () => {
  const rates = new Rates();
  rates.update(jobAt(100), 10);
  const rate = rates.update(jobAt(140), 12);
  near(rate.perSecond, 20);
});

test('a later pace counts the more the longer it lasts, forgetting over three seconds', () => {
  const rates = new Rates();
  rates.update(jobAt(0), 0);
  rates.update(jobAt(10), 1);
  near(rates.update(jobAt(60), 4).perSecond, 10 + (1 - Math.exp(-1)) * (50 / 3 - 10));
});

test('an answer at the same time changes nothing', () => {
  const rates = new Rates();
  rates.update(jobAt(0), 0);
  rates.update(jobAt(10), 1);
  near(rates.update(jobAt(10), 1).perSecond, 10);
});

test('a job that is begun anew has no pace', () => {
  const rates = new Rates();
  rates.update(jobAt(0), 0);
  rates.update(jobAt(500), 1);
  assert.equal(rates.update(jobAt(3), 2), null);
  near(rates.update(jobAt(4), 3).perSecond, 1);
});

test('jobs are told apart, and forgotten', () => {
  const rates = new Rates();
  for (const [time, a, b] of [[0, 0, 0], [1, 5, 7]]) {
    rates.update(jobAt(a), time);
    rates.update(jobAt(b, 'b'), time);
  }
  rates.keep(new Set(['b']));
  assert.equal(rates.of(jobAt(5)), null);
  near(rates.of(jobAt(7, 'b')).perSecond, 7);
});

test('a pace is told once a second is measured', () => {
  const rates = new Rates();
  rates.update(jobAt(0), 0);
  assert.equal(rates.update(jobAt(500), .001), null);
  near(rates.update(jobAt(600), 2).perSecond, 300);
  near(rates.update(jobAt(900), 2.5).perSecond, 300);
});
