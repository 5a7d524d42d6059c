# Puts a switch for the number that a scale fault brings: `crate::fault::number(K, of_the_code, of_the_fault)`. Reads lines of
# name, file, line, with, verify; writes name, file, line, with the switch. A number that stands beside nothing was a factor of 1.

# The numbers of a line, in order, into `found`; their places into `at`.
function numbers(line, found, at,    count, place, rest, before) {
    count = 0; place = 1
    while (match(substr(line, place), /[0-9][0-9_]*(\.[0-9]+)?/)) {
        before = substr(line, place + RSTART - 2, 1)
        if (place + RSTART - 2 < 1 || before !~ /[A-Za-z0-9_.]/) { count++; found[count] = substr(line, place + RSTART - 1, RLENGTH); at[count] = place + RSTART - 1 }
        place += RSTART + RLENGTH - 1
    }
    return count
}

BEGIN { FS = OFS = "\t" }
{
    split("", left); split("", right); split("", at); split("", unused); split("", seen)
    old = numbers($3, left, unused); new = numbers($4, right, at)
    for (i = 1; i <= old; i++) seen[left[i]]++
    fresh = 0
    for (i = 1; i <= new; i++) if (seen[right[i]] > 0) seen[right[i]]--; else { fresh++; here = i }
    lost = "1.0"; gone = 0
    for (i = 1; i <= old; i++) if (seen[left[i]] > 0) { gone++; lost = left[i]; seen[left[i]]-- }
    if (fresh != 1 || gone > 1) next
    switch_ = "crate::fault::number(" NR ", " lost ", " right[here] ")"
    print $1, $2, $3, substr($4, 1, at[here] - 1) switch_ substr($4, at[here] + length(right[here])), $5, NR
}
