// The two ways to the program's one function: `Explore.server(base)` and `Explore.module(base64OfGzip)`.
//
// Both return { ask(question, lane, { slow, coarse }) -> Promise<answer> }. A lane is one thing on the page that waits for
// an answer: a newer question of a lane takes the place of one that waits, which rejects with `Explore.superseded`. A running
// one that is superseded is ended when it gets old. So a hundred quick moves leave one last answer and no backlog.
"use strict";
(() => {
  // Superseded runs are ended at these ages in milliseconds. A coarse one is let go on a little longer, as on a slow machine
  // nothing would be seen during a drag otherwise.
  const AGE = 150;
  const COARSE_AGE = 400;

  /** Lanes over workers `{ slow: false, true or "last": the slowest questions that it takes, run(text) -> Promise<answer>, stop() }`. */
  Explore.pool = (workers) => {
    const waiting = new Map();
    const running = new Set();
    const counts = { asked: 0, answered: 0, superseded: 0, ended: 0, times: [] };
    const end = (job) => {
      if (!running.has(job)) return;
      running.delete(job);
      clearTimeout(job.timer);
      counts.ended += 1;
      job.worker.stop();
      job.worker.busy = false;
      job.reject(Explore.superseded);
      next();
    };
    const supersede = (lane) => {
      const queued = waiting.get(lane);
      if (queued) { waiting.delete(lane); counts.superseded += 1; queued.reject(Explore.superseded); }
      running.forEach((job) => {
        if (job.lane !== lane || job.timer) return;
        job.timer = setTimeout(() => end(job), Math.max(0, (job.coarse ? COARSE_AGE : AGE) - (performance.now() - job.began)));
      });
    };
    // Quick questions first, in the order in which they came. A lane whose coarse question runs waits for it, so that answers
    // come in order; a superseded full question is waited for by nobody.
    const rank = (slow) => (slow === "last" ? 2 : Number(Boolean(slow)));
    const free = (job) => workers.find((worker) => !worker.busy && rank(job.slow) <= rank(worker.slow));
    const next = () => {
      [...waiting.values()].sort((a, b) => rank(a.slow) - rank(b.slow)).forEach((job) => {
        if ([...running].some((each) => each.lane === job.lane && each.coarse)) return;
        const worker = free(job);
        if (!worker) return;
        waiting.delete(job.lane);
        running.forEach((each) => { if (each.lane === job.lane) each.dropped = true; });
        start(job, worker);
      });
    };
    const start = (job, worker) => {
      worker.busy = true;
      job.worker = worker;
      job.began = performance.now();
      running.add(job);
      const finish = (then) => (value) => {
        if (!running.has(job)) return;
        running.delete(job);
        clearTimeout(job.timer);
        worker.busy = false;
        then(value);
        next();
      };
      worker.run(job.text, job.lane).then(finish((answer) => {
        counts.answered += 1;
        counts.times.push([job.lane, job.coarse, performance.now() - job.began]);
        if (counts.times.length > 2000) counts.times.shift();
        if (job.dropped) job.reject(Explore.superseded); else job.resolve(answer);
      }), finish((problem) => job.reject(problem)));
    };
    return {
      counts,
      pending: () => waiting.size + running.size,
      ask: (question, lane, { slow = false, coarse = false } = {}) => new Promise((resolve, reject) => {
        counts.asked += 1;
        supersede(lane);
        waiting.set(lane, { lane, slow, coarse, text: JSON.stringify(question), resolve, reject, timer: null, dropped: false });
        next();
      }),
    };
  };

  // The server ---------------------------------------------------------------------------------------------------------

  /** The program on this machine, below `base` (its address with the token; "" where the page came from there). */
  Explore.server = (base) => {
    const root = base === "" || base.endsWith("/") ? base : `${base}/`;
    let sequence = 0;
    const caller = (slow) => {
      let controller = null;
      return {
        slow,
        run: async (text, lane) => {
          controller = new AbortController();
          sequence += 1;
          const place = `lane=${encodeURIComponent(lane)}&sequence=${sequence}`;
          let response;
          try {
            response = await fetch(`${root}answer?${place}`, { method: "POST", headers: { "Content-Type": "application/json" }, body: text, signal: controller.signal });
          } catch (problem) {
            throw problem.name === "AbortError" ? Explore.superseded : new Error("The program has ended. Start it again with corner-impact explore, then load this page again.");
          }
          // The program has stopped this question for a newer one of its lane.
          if (response.status === 409) throw Explore.superseded;
          if (!response.ok) throw new Error((await response.text()) || `The program answered with status ${response.status}.`);
          return response.json();
        },
        stop: () => controller && controller.abort(),
      };
    };
    // The server ends when nobody has asked for a while: a question that it answers late shows that the page is open.
    const alive = async () => {
      for (;;) {
        try { await (await fetch(`${root}alive`)).text(); } catch { await new Promise((resolve) => setTimeout(resolve, 3000)); }
        await new Promise((resolve) => setTimeout(resolve, 200));
      }
    };
    alive();
    return { ...Explore.pool([caller(false), caller(false), caller(true), caller("last")]), kind: "server" };
  };

  // The module -----------------------------------------------------------------------------------------------------------

  // Runs in a worker: it has no access to the page, so it is a function turned to text.
  const inside = (scope) => {
    let instance = null;
    const reply = (text) => {
      const { memory, allocate, answer, answer_length } = instance.exports;
      const bytes = new TextEncoder().encode(text);
      const asked = allocate(bytes.length);
      new Uint8Array(memory.buffer, asked, bytes.length).set(bytes);
      // Memory may have grown meanwhile: the view of it is made anew.
      const found = answer();
      return new TextDecoder().decode(new Uint8Array(memory.buffer, found, answer_length()));
    };
    let ready = null;
    scope.onmessage = async ({ data }) => {
      if (data.module) { ready = WebAssembly.instantiate(data.module, {}); ready.catch(() => {}); return; }
      try {
        instance = await ready;
        // Parsed here: four megabytes of text would hold up the page.
        scope.postMessage({ answer: JSON.parse(reply(data.text)) });
      } catch (problem) {
        scope.postMessage({ failed: String(problem && problem.message ? problem.message : problem) });
      }
    };
  };

  /** The module beside the page's own script, for pages that may not start workers, as in some notebooks. */
  const beside = () => {
    const scope = {};
    const made = { ended: false, terminate: () => { made.ended = true; }, postMessage: (data) => setTimeout(() => scope.onmessage({ data })) };
    scope.postMessage = (data) => setTimeout(() => { if (!made.ended) made.onmessage({ data }); });
    inside(scope);
    return made;
  };

  const unpack = async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (sign) => sign.charCodeAt(0));
    const plain = await new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
    return WebAssembly.compile(plain);
  };

  // One worker is kept for quick questions, one for slow ones at most, and one takes those of many seconds.
  /** The program as a WebAssembly module inside the page: base64 of its gzip. */
  Explore.module = (base64) => {
    const compiled = unpack(base64.replace(/\s+/g, "")).catch((problem) => { throw new Error(`The program in this page cannot be started in this browser: ${problem.message}`); });
    const address = URL.createObjectURL(new Blob([`(${inside})(self)`], { type: "text/javascript" }));
    let [allowed, proved] = [true, false];
    const started = () => { if (allowed) { try { return new Worker(address); } catch { allowed = false; } } return beside(); };
    const worker = (slow) => {
      // `thread` is a promise of the Web Worker in force; `job` is what it runs.
      let [thread, job] = [null, null];
      const give = () => { const given = job; job = null; return given; };
      const failed = (message) => {
        // The memory of a module that has trapped cannot be trusted: the next question gets a new one.
        if (thread) thread.then((each) => each.terminate());
        thread = null;
        const given = give();
        if (given) given.reject(new Error(`The program in the page has failed: ${message}`));
      };
      const begin = async () => {
        const module = await compiled;
        const made = started();
        made.onmessage = ({ data }) => { proved = true; if (data.failed !== undefined) failed(data.failed); else { const given = give(); if (given) given.resolve(data.answer); } };
        made.onerror = (event) => {
          if (proved) { failed(event.message || "its Web Worker ended"); return; }
          // No worker has ever answered: they are forbidden here.
          allowed = false;
          thread = null;
          ready().then((each) => { if (job) each.postMessage({ text: job.text }); });
        };
        made.postMessage({ module });
        return made;
      };
      const ready = () => { thread = thread || begin(); return thread; };
      ready().catch(() => {});
      return {
        slow,
        run: (text) => new Promise((resolve, reject) => {
          const own = { resolve, reject, text };
          job = own;
          ready().then((each) => { if (job === own) each.postMessage({ text }); }, reject);
        }),
        // A run cannot be cancelled inside the module: the worker goes, and another stands ready.
        stop: () => {
          job = null;
          if (thread) thread.then((each) => each.terminate(), () => {});
          thread = null;
          ready().catch(() => {});
        },
      };
    };
    return { ...Explore.pool([worker(false), worker(true), worker("last")]), kind: "module", ready: compiled };
  };
})();
