"""The contract kernels against plain models: a queue, a table, a list of parts, a cut path."""

from collections import deque

from hypothesis import given, settings
from hypothesis import strategies as st

from cratous.core.contracts import building, checklists, requests, segments, tasks, validity
from cratous.spec.contracts import tasks as table

EVENTS = st.lists(
    st.tuples(st.sampled_from([1, 2, 3]), st.integers(0, 6), st.integers(0, 30)), max_size=60
)


@given(EVENTS, st.integers(1, 5))
def test_line_behaves_like_a_queue(events, limit_ms):
    line, now = requests.Line(0, 0, False, 0), 0
    waiting: deque[int] = deque()
    planned, since, count, answered = None, 0, 0, []
    for event, ticket, dt in events:
        now += dt
        step = requests.line_step(line, event, ticket, now, limit_ms)
        if event == 1:
            waiting.append(count)
            assert (step.act, step.ticket) == (requests.TAKE, count)
            count += 1
        elif event == 2 and planned == ticket:
            assert (step.act, step.ticket) == (requests.PASS_ON, ticket)
            answered.append(ticket)
            planned = None
        elif event == 2:
            assert step == requests.Step(line, requests.LATE, ticket)
        elif planned is not None and now - since >= limit_ms:
            assert (step.act, step.ticket) == (requests.GIVE_UP, planned)
            answered.append(planned)
            planned = None
        elif planned is None and waiting:
            planned, since = waiting.popleft(), now
            assert (step.act, step.ticket) == (requests.PUBLISH, planned)
        else:
            assert step.act == requests.NOTHING
            assert step.line == line
        line = step.line
    assert answered == list(range(len(answered)))


@given(EVENTS)
def test_watched_line_is_in_order(events):
    assert requests.requests_in_order(events, 7, 1, 3)


def test_a_full_line_refuses():
    line = requests.Line(2**60, 0, False, 0)
    assert requests.line_step(line, 1, 0, 0, 1) == requests.Step(line, requests.FULL, 2**60)


@given(st.lists(st.tuples(st.integers(0, 5), st.booleans(), st.booleans(), st.booleans())))
def test_requests_are_valid_iff_all_they_name_is(things):
    fine = all(
        (kind == 1 and known and (ready or given_))
        or (kind == 2 and known and ready)
        or (kind in (3, 4) and known)
        for kind, known, ready, given_ in things
    )
    both = {1, 2} <= {kind for kind, *_ in things}
    assert validity.request_valid(things) == (fine and both)


@given(st.lists(st.integers(-2, 9), max_size=20), st.integers(-3, 80))
def test_every_id_has_one_owner(counts, number):
    free, owners = 1, 0
    for count in counts:
        block = range(free, free + max(count, 0))
        owners += number in block
        free += len(block)
    assert checklists.owners_of([(count,) for count in counts], number) == owners
    assert owners == (1 <= number < free)


@given(st.lists(st.booleans()))
def test_list_is_complete_iff_all_is_ticked(ticks):
    assert checklists.list_complete([(tick,) for tick in ticks]) == all(ticks)


@given(st.lists(st.tuples(st.sampled_from(table.EVENTS), st.integers(1, 5)), max_size=60))
def test_task_begins_the_newest_request_that_it_was_told_of(events):
    task, newest = tasks.Task(0, 0, 0), 0
    for event, request in events:
        before = task
        task, act = tasks.task_step(task, event, request)
        if event == table.REQUESTED and request > newest:
            newest = request
        assert newest in (task.request, task.kept)
        if act == table.COMPLETE:
            assert before.state in (table.OPTION_SELECTED, table.ACTIVE)


@given(
    st.integers(-1, 6),
    st.lists(st.tuples(st.integers(1, 3), st.integers(0, 6)), max_size=30),
)
def test_parts_are_asked_for_in_order(count, events):
    b = building.Building(0, 0, 0)
    asked, built, answers = [], [], []
    for event, number in [(1, count), *events]:
        b, act, part, done = building.building_step(b, event, number)
        if done:
            built.append(number)
        if act == 1:
            asked.append(part)
        if act in (2, 3):
            answers.append((act, list(built)))
    assert asked == list(range(len(asked)))
    assert built == list(range(len(built)))
    assert len(answers) <= 1
    assert all(act == 3 or done == list(range(count)) for act, done in answers)
    assert building.parts_in_order([(1, count), *events], 0, 1)


@settings(max_examples=200)
@given(st.integers(1, 60), st.integers(2, 15), st.data())
def test_pieces_are_the_path(count, length, data):
    overlap = data.draw(st.integers(1, length - 1))
    span = segments.first_span(count - 1, length)
    served = list(range(span.first, span.last + 1))
    while span.last < count - 1:
        following = segments.span_after(span, count - 1, length, overlap)
        assert len(set(range(following.first, following.last + 1)) & set(served)) == overlap
        served += range(span.last + 1, following.last + 1)
        span = following
    assert served == list(range(count))
    assert segments.span_after(span, count - 1, length, overlap) == span


def test_a_path_may_lead_back():
    walk = [0]
    for _ in range(6):
        walk.append(segments.waypoint_after(walk[-1], 4, 1))
    assert walk == [0, 1, 2, 3, 1, 2, 3]
