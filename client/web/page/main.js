// The page: what is shown follows the address behind '#'.
import { isAway, isGone } from './api.js';
import { showProblem } from './dialogs.js';
import { byId, button } from './elements.js';
import { JobView } from './job.js';
import { JobList } from './jobs.js';
import { NewJob } from './mesh.js';
import { Overview } from './overview.js';
import { Poll, pauseAfter } from './poll.js';
import { Rates } from './rate.js';
import { forget, openSession, session, signOut } from './session.js';
import { signInView } from './sign_in.js';

let poll = null;

function viewOfAddress() {
  const [view, id] = location.hash.slice(1).split('/');
  if (view === 'new') return new NewJob(id && decodeURIComponent(id));
  if (view === 'job' && id) return new JobView(decodeURIComponent(id), new Rates());
  if (view === 'server' && session.admin) return new Overview(new Rates());
  return new JobList(new Rates());
}

function markPlace() {
  for (const link of document.querySelectorAll('header nav a')) {
    const here = link.getAttribute('href') === (location.hash || '#jobs');
    if (here) link.setAttribute('aria-current', 'page');
    else link.removeAttribute('aria-current');
  }
}

function present(element, title) {
  byId('view').replaceChildren(element);
  document.title = `${title} – affskel`;
}

/** @param {string} [message] */
function showSignIn(message = '') {
  if (poll) poll.stop();
  document.body.classList.remove('signed-in');
  showProblem(null);
  present(signInView(enter, message), 'Sign in');
  (byId('token') || byId('view').querySelector('h1')).focus();
}

// @param moved whether the user went there: then the heading takes the focus, so that it is read.
function showView(moved) {
  if (poll) poll.stop();
  showProblem(null);
  /** @type {View} */
  const view = viewOfAddress();
  present(view.element, view.title);
  markPlace();
  const { ask } = view;
  if (ask) {
    poll = new Poll(
      (signal) => ask.call(view, signal),
      (error) => {
        if (error?.status === 401) return;
        const gone = isGone(error);
        if (gone) poll.stop();
        showProblem(error && (gone ? error.message : `${error.message} Trying again …`));
      },
    );
    view.refresh = () => poll.now();
    view.pause = () => poll.stop();
    poll.now();
  }
  const heading = view.element.querySelector('h1');
  if (moved && heading) heading.focus();
}

function enter() {
  document.body.classList.add('signed-in');
  byId('who').textContent = session.owner;
  byId('server-link').hidden = !session.admin;
  byId('sign-out').hidden = session.mode === 'personal';
  showView(true);
}

async function leave() {
  try {
    await signOut();
  } catch {
    forget(); // it has ended already, or the service is gone
  }
  history.replaceState(null, '', location.pathname); // where this person was is not for the next
  showSignIn();
}

// While the server is away: whoever opens the page then has it as soon as it is back.
async function openPatiently() {
  for (let tries = 1; ; tries += 1) {
    try {
      return await openSession();
    } catch (error) {
      if (!isAway(error)) throw error;
      showProblem(`${error.message} Trying again …`);
    }
    await new Promise((resolve) => setTimeout(resolve, pauseAfter(tries)));
  }
}

async function begin() {
  byId('account').append(button('Sign out', leave, { id: 'sign-out' }));
  byId('skip').addEventListener('click', (event) => {
    event.preventDefault(); // what is behind '#' names a view
    byId('view').focus();
  });
  window.addEventListener('hashchange', () => {
    if (session.signed_in) showView(true);
    else if (location.hash.includes('key=')) location.reload(); // the address of a new page, pasted
  });
  document.addEventListener('signed-out', () => {
    if (!session.signed_in) return;
    forget();
    showSignIn('The session has ended.');
  });
  try {
    await openPatiently();
  } catch (error) {
    return showSignIn(error.status === 401 ? 'The address has been used before.' : error.message);
  }
  return session.signed_in ? enter() : showSignIn();
}

begin();
