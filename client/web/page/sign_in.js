// The page before anybody is signed in.
import { h } from './elements.js';
import { session, signIn } from './session.js';

/**
 * What stands in the page; `entered` is called once a user is signed in.
 * @param {() => void} entered
 * @param {string} [message]
 * @returns {HTMLElement}
 */
export function signInView(entered, message = '') {
  return session.mode === 'personal' ? keyView(message) : tokenView(entered, message);
}

/** @param {string} message */
function keyView(message) {
  return h(
    'section',
    { class: 'narrow card' },
    h('h1', { tabindex: -1 }, 'This page is locked'),
    message && h('p', { class: 'error', role: 'alert' }, message),
    h('p', {}, 'It belongs to whoever started it, and its address opens it once.'),
    h('p', {}, 'To open it in this browser, start it again in a terminal:'),
    h('pre', {}, 'affskel-client web'),
  );
}

/** @param {string} message */
function tokenView(entered, message) {
  const field = h('input', {
    id: 'token',
    type: 'password',
    autocomplete: 'current-password',
    autocapitalize: 'none',
    spellcheck: 'false',
    required: true,
    'aria-describedby': 'token-help',
  });
  const problem = h('p', { class: 'error', role: 'alert', hidden: !message }, message);
  const submit = h('button', { type: 'submit', class: 'primary' }, 'Sign in');
  const form = h(
    'form',
    { class: 'narrow card' },
    h('h1', { tabindex: -1 }, 'Sign in'),
    problem,
    h('label', { for: 'token' }, 'Your token'),
    field,
    h('p', { id: 'token-help', class: 'small' }, 'Whoever runs the server made it for you. It is not stored in this browser.'),
    submit,
  );
  form.addEventListener('submit', async (event) => {
    event.preventDefault();
    submit.disabled = true;
    problem.hidden = true;
    try {
      await signIn(field.value.trim());
      field.value = '';
      entered();
    } catch (error) {
      problem.textContent =
        error.status === 401 || error.status === 403
          ? `That did not work: ${error.message}. Check that the whole token was pasted.`
          : error.message;
      problem.hidden = false;
      field.focus();
      field.select();
    } finally {
      submit.disabled = false;
    }
  });
  return form;
}
