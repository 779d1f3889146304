// poll.js: an answer that comes after a newer question is not shown.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ApiError, call, isAway } from '../../client/web/page/api.js';
import { Poll } from '../../client/web/page/poll.js';
import { installDocument } from './fake_document.js';

installDocument();

// A service whose answers come when the test lets them; a call whose signal has ended gets none, as of fetch.
function heldService() {
  const held = [];
  globalThis.fetch = (path, { signal }) =>
    new Promise((resolve, reject) => {
      signal.addEventListener('abort', () => reject(signal.reason));
      held.push({ path, answer: (value) => resolve(new Response(JSON.stringify(value))) });
    });
  return held;
}

test('of two questions the newer one is answered, in whatever order the answers come', async () => {
  const held = heldService();
  const shown = [];
  const failures = [];
  const ask = async (signal) => {
    shown.push(await call('GET', `/api/jobs?question=${held.length}`, undefined, signal));
    return false;
  };
  const poll = new Poll(ask, (error) => failures.push(error));
  const older = poll.now();
  const newer = poll.now();
  held[1].answer('newer');
  await newer;
  held[0].answer('older');
  await older;
  poll.stop();
  assert.deepEqual(held.map(({ path }) => path), ['/api/jobs?question=0', '/api/jobs?question=1']);
  assert.deepEqual(shown, ['newer']);
  assert.deepEqual(failures, []);
});

test('what is stopped shows nothing and tells no failure', async () => {
  const held = heldService();
  const shown = [];
  const poll = new Poll(
    async (signal) => shown.push(await call('GET', '/api/jobs', undefined, signal)) > 0,
    (error) => shown.push(error),
  );
  const asked = poll.now();
  poll.stop();
  held[0].answer('too late');
  await asked;
  assert.deepEqual(shown, []);
});

test('a failure is told, and that it is over', async () => {
  const told = [];
  let broken = true;
  const poll = new Poll(
    async () => {
      if (broken) throw new Error('no answer');
      return false;
    },
    (error) => told.push(error && error.message),
  );
  await poll.now();
  broken = false;
  await poll.now();
  poll.stop();
  assert.deepEqual(told, ['no answer', null]);
});

test('only a server that is away comes back by itself', () => {
  const away = (status) => isAway(new ApiError(status, 'X', 'x'));
  assert.deepEqual([0, 401, 403, 429, 500, 502, 503, 504, 507].filter(away), [0, 502, 503, 504]);
  assert.equal(isAway(new TypeError('of the page itself')), false);
});
