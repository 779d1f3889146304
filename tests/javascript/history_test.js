// history.js: the events of a job in words.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { History } from '../../client/web/page/history.js';
import { moment } from '../../client/web/page/numbers.js';
import { installDocument } from './fake_document.js';

installDocument();

const kTime = Date.UTC(2024, 1, 29, 12);

// The lines that events give.
function linesOf(...events) {
  const history = new History('job');
  history.show(events.map((event) => ({ time_ms: kTime, task: 0, worker: '', message: '', ...event })));
  return history.list.children.map((line) => line.textContent);
}

test('an event has its time and its words', () => {
  assert.deepEqual(linesOf({ number: 1, event: 'task_failed' }), [`${moment(kTime)} a task failed`]);
});

test('one that has no words of its own is shown as it is', () => {
  assert.deepEqual(linesOf({ number: 1, event: 'new_thing' }), [`${moment(kTime)} new_thing`]);
});

test('task, worker and message follow, the worker shortened', () => {
  const event = { number: 1, event: 'leased', task: 7, kind: 'erode', worker: '0123456789abcdef', message: 'again' };
  assert.deepEqual(linesOf(event), [`${moment(kTime)} given to a worker, task 7 (erode), worker 0123456789ab, again`]);
  assert.match(linesOf({ number: 1, event: 'leased', task: 7 })[0], /, task 7$/);
});

test('what is left out is counted, at the beginning and between', () => {
  const lines = linesOf({ number: 3, event: 'a' }, { number: 4, event: 'b' }, { number: 6, event: 'c' });
  assert.deepEqual(
    lines.map((line) => line.replace(moment(kTime), '').trim()),
    ['… 2 events left out', 'a', 'b', '… 1 event left out', 'c'],
  );
});

test('nothing is asked while it is closed, and a failure is told', async () => {
  const history = new History('a job');
  const asked = [];
  globalThis.fetch = async (path) => {
    asked.push(path);
    return new Response('{"error": {"code": "NOT_FOUND", "message": "there is no such job"}}', { status: 404 });
  };
  await history.refresh();
  assert.deepEqual(asked, []);
  history.element.open = true;
  await history.refresh();
  assert.deepEqual(asked, ['/api/jobs/a%20job/events']);
  assert.equal(history.problem.textContent, 'there is no such job');
  assert.equal(history.problem.hidden, false);
});
