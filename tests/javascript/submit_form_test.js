// submit_form.js: what is asked of a mesh.
import assert from 'node:assert/strict';
import { webcrypto } from 'node:crypto';
import { test } from 'node:test';
import { session } from '../../client/web/page/session.js';
import { SubmitForm, jobName } from '../../client/web/page/submit_form.js';
import { fakeElement, installDocument } from './fake_document.js';

installDocument();
document.getElementById = () => fakeElement();
globalThis.crypto ??= webcrypto;
globalThis.location = { hash: '' };
Object.assign(session, {
  words: { minima: { set: '' }, frames: { axis: '', pca: '' }, operators: { ridge: '', sobel: '' } },
  usual: { minimum: 'set', frame: 'axis', operator: 'ridge' },
});

const kJob = {
  params: { sampling: { target_points: 700 }, directions: 'random:40:18446744073709551615', frame: 'pca', minimum: 'set' },
  skeleton: { operator: 'sobel', threshold: 0.25 },
};

// A form, and the jobs that it asks for; the service answers in order, null is no answer.
function formWith(...answers) {
  const asked = [];
  globalThis.fetch = async (path, { body }) => {
    if (path !== '/api/jobs') return new Response('{"counted": true, "points": 700, "spacing": 1}');
    asked.push(JSON.parse(body));
    const answer = answers.shift();
    if (answer === null) throw new TypeError('the network is down');
    return new Response(JSON.stringify({ id: 'j', name: 'm', existed: false, ...answer }));
  };
  const form = new SubmitForm({ mesh: 'k', name: 'm.off', facts: { volume: 1000 } });
  Object.assign(form.frame, { value: 'axis' });
  Object.assign(form.directions, { value: 'triangles' });
  Object.assign(form.minimum, { value: 'set' });
  return { form, asked };
}

test('a name may be as long as elsewhere, and is told by how much it is longer', async () => {
  const { form, asked } = formWith({});
  form.name.value = 'é'.repeat(100);
  await form.send();
  assert.equal(asked[0].name, 'é'.repeat(100));
  form.name.value = '形'.repeat(70);
  await form.send();
  assert.equal(asked.length, 1);
  assert.match(form.problem.textContent, /^The name is 10 bytes too long: it may have 200/);
  assert.equal(jobName(`${'形'.repeat(70)}.off.gz`), '形'.repeat(66), 'as far as there is room');
  assert.equal(jobName('body.off'), 'body');
});

test('what is advised of directions is shown while these are asked for, and can be taken', async () => {
  const advice = [{ message: 'many directions', to_try: [{ name: 'directions', value: 'sphere:5000' }] }];
  const { form, asked } = formWith({});
  form.mesh.advice = advice;
  form.directions.give('triangles', 'change');
  assert.equal(form.advice.hidden, false);
  assert.match(form.advice.textContent, /^Note: many directions\. Take these$/);
  form.advice.querySelector('button').dispatchEvent(new Event('click'));
  assert.equal(form.advice.hidden, true);
  await form.send();
  assert.equal(asked[0].directions, 'sphere:5000');
  form.directions.give('triangles', 'change');
  assert.equal(form.advice.hidden, false);
  form.mesh.advice = undefined;
  form.advise();
  assert.equal(form.advice.hidden, true);
});

test('like a job means its threshold and its seed, too', async () => {
  const { form, asked } = formWith({});
  form.like(kJob);
  await form.send();
  assert.equal(asked[0].directions, 'random:40:18446744073709551615');
  assert.equal(asked[0].operator, 'sobel');
  assert.equal(asked[0].threshold, 0.25);
  assert.equal(asked[0].points, 700);
});

test('a threshold is of its operator', async () => {
  const { form, asked } = formWith({});
  form.like(kJob);
  form.operator.give('ridge', 'change');
  await form.send();
  assert.equal('threshold' in asked[0], false);
});

test('a threshold that is none is told', async () => {
  const { form, asked } = formWith();
  form.threshold.value = '-1';
  await form.send();
  assert.deepEqual(asked, []);
  assert.match(form.problem.textContent, /threshold must be a number above 0/);
});

test('after a lost answer the same is the same request, anything else another', async () => {
  const { form, asked } = formWith(null, null, {}, {});
  await form.send();
  await form.send();
  form.frame.value = 'pca';
  await form.send();
  await form.send();
  const ids = asked.map((one) => one.request_id);
  assert.equal(ids[1], ids[0]);
  assert.notEqual(ids[2], ids[1]);
  assert.notEqual(ids[3], ids[2], 'what was answered is done');
});
