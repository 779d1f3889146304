// jobs.js: what the cards of jobs show.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { fakeElement, installDocument } from './fake_document.js';

installDocument();
globalThis.location = { hash: '' };
globalThis.IntersectionObserver = class {
  observe() {}
};
const { showProgress } = await import('../../client/web/page/jobs.js');

test('a bar moves without a share only while something goes on', () => {
  for (const [state, value] of [['queued', 0], ['cancelled', 0], ['running', undefined]]) {
    const bar = Object.assign(fakeElement('progress'), { value: 0.5, removeAttribute: () => delete bar.value });
    showProgress(bar, { name: 'm', state });
    assert.equal(bar.value, value, state);
    assert.equal(bar.hidden, false, state);
  }
});
