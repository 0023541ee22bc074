// `goto` backward: it repeats the statements from a label on.

// tried(0) == 101: once
// tried(3) == 404: until the fourth attempt
// tried(9) == -5: five attempts, then it gives up
int tried(int failures)
{
    int attempts = 0;
again:
    attempts++;
    if (attempts <= failures) {
        if (attempts == 5) goto failed;
        goto again;
    }
    return attempts * 100 + attempts;
failed:
    return -attempts;
}
// from_a_loop(5) == 303: the third turn of the loop begins all again, twice
int from_a_loop(int n)
{
    int rounds = 0, sum = 0, i;
round:
    rounds++;
    sum = 0;
    for (i = 0; i < n; i++) {
        while (1) {
            if (i == 2 && rounds < 3) goto round;
            break;
        }
        if (i == 3) break;
        sum += i;
    }
    return rounds * 100 + sum;
}
// two_labels(5) == 11: once through both
// two_labels(30) == 63: 11, 22 and 33 from `both` on, then 43, 53 and 63 from `tens` on
int two_labels(int least)
{
    int n = 0;
both:
    n++;
tens:
    n += 10;
    if (n < least) goto both;
    if (n < 2 * least) goto tens;
    return n;
}
// in_a_loop(3) == 6: 1 + 2 + 3 repetitions
int in_a_loop(int turns)
{
    int i, count = 0;
    for (i = 1; i <= turns; i++) {
        int k = 0;
        if (i == 0) continue;
more:
        k++;
        count++;
        if (k < i) goto more;
    }
    return count;
}
