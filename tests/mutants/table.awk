# Writes docs/mutation.md: reads tests/mutants/equivalent.tsv, the list of scale faults, and tests/mutants/results.tsv.

# ln k!
function log_factorial(k,    i, sum) {
    for (i = 2; i <= k; i++) sum += log(i)
    return sum + 0
}

# P(X >= k) of a binomial law.
function upper_tail(k, n, p,    i, sum) {
    if (k <= 0) return 1
    if (p <= 0) return 0
    if (p >= 1) return 1
    for (i = k; i <= n; i++)
        sum += exp(log_factorial(n) - log_factorial(i) - log_factorial(n - i) + i * log(p) + (n - i) * log(1 - p))
    return sum
}

# The p at which P(X >= k) is `tail`, by halving.
function solve(k, n, tail,    low, high, middle, i) {
    low = 0; high = 1
    for (i = 0; i < 50; i++) {
        middle = (low + high) / 2
        if (upper_tail(k, n, middle) < tail) low = middle; else high = middle
    }
    return middle
}

# Share and its interval of Clopper and Pearson (1934): 2.5 % beyond either end, whatever the share.
function share(k, n,    low, high) {
    if (n == 0) return "-"
    low = k == 0 ? 0 : solve(k, n, 0.025)
    high = k == n ? 1 : solve(k + 1, n, 0.975)
    return sprintf("%.1f %% [%.1f, %.1f]", 100 * k / n, 100 * low, 100 * high)
}

# A share only of a whole: those that were not run are not a random part of it, since the ones that survive take longest.
function share_of_all(k, n, run, all) {
    if (run < all) return sprintf("not complete: %d of %d", k, n)
    return share(k, n)
}

BEGIN {
    count = split(sizes, rows, "\n")
    for (i = 1; i <= count; i++) { split(rows[i], row, " "); crates[i] = row[1]; size[row[1]] = row[2] }
}

FILENAME ~ /equivalent\.tsv$/ { if ($0 !~ /^#/ && NF > 1) reason[$1] = $2; next }

$1 == "list" {
    crate = $3; sub(/^crates\//, "", crate); sub(/\/.*/, "", crate)
    faults[crate]++; all_faults++
    if ($6 != "") must_verify[$2] = 1
    next
}

$1 == "fault" {
    fault_run[$3]++; faults_run++
    if ($4 == "caught" || $4 == "endless") { fault_caught[$3]++; faults_caught++; fault_stage[$3 $5]++ }
    else open_faults = open_faults "- `" $2 "` (" $3 "): " $4 "\n"
    if ($2 in must_verify) {
        verify_run[$3]++; verify_all++
        if ($5 == "laws" || $6 ~ /; verify$/) { verify_caught[$3]++; verify_ok++ }
        else open_faults = open_faults "- `" $2 "` (" $3 "): not noticed by the checks without chance\n"
    }
}

$1 == "mutant" {
    run[$3]++; all_run++
    revisions[$8] = 1
    if ($4 == "unbuildable") { unbuildable[$3]++; all_unbuildable++ }
    else if (($4 == "missed" || $4 == "equivalent") && $2 in reason) { equivalent[$3]++; all_equivalent++; reasons = reasons "- `" $2 "`: " reason[$2] "\n" }
    else {
        viable[$3]++; all_viable++
        if ($4 == "missed") missed = missed "- `" $2 "`\n"
        else { caught[$3]++; all_caught++; stage[$3 $5]++; if ($4 == "endless") endless[$3]++ }
    }
}

END {
    print "# Mutation score"
    print ""
    print "Written by `tests/mutants/run table` from [tests/mutants](../tests/mutants): do not edit. A mutant is one small fault in one formula; the tests"
    print "must notice. Each meets the tests of its own crate (unit tests and `tests/` of the crate), what survives the checks without chance of"
    print "`fairflight-catalogue` and `fairflight-laws` (`exact/…` and `collision/…` of `verify`), what survives these `tests/`. The stage that notices it counts once."
    print "Intervals are those of Clopper and Pearson at 95 %."
    print ""
    print "## Scale faults"
    print ""
    print "One factor of 1.003 to 1.05 in one formula, chosen by hand to be hard to see: [scale-faults.toml](../tests/mutants/scale-faults.toml). Of"
    print "those that concern a decision, a density, a closed form or a connection, the checks without chance, which `verify` runs on any seed, must"
    print "notice each (last column)."
    print ""
    print "| crate | faults | run | own tests | laws | tests/ | noticed | by checks without chance |"
    print "|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= count; i++) {
        c = crates[i]
        printf "| %s | %d | %d | %d | %d | %d | %s | %d of %d |\n", c, faults[c], fault_run[c], fault_stage[c "own"], fault_stage[c "laws"], fault_stage[c "tests"], share_of_all(fault_caught[c] + 0, faults[c] + 0, fault_run[c] + 0, faults[c] + 0), verify_caught[c], verify_run[c]
    }
    printf "| **all** | %d | %d | | | | %s | %d of %d |\n", all_faults, faults_run, share_of_all(faults_caught + 0, all_faults + 0, faults_run + 0, all_faults + 0), verify_ok, verify_all
    print ""
    if (open_faults != "") print "Not noticed:\n\n" open_faults
    print "## A sample of cargo-mutants' mutants"
    print ""
    print "Drawn by `tests/mutants/run draw`: the mutants whose names come first in an order by a salted hash, for each crate in proportion to how many it"
    print "has and no fewer than 25. Of media: phase functions, quadrature and profiles. Implementations of `Display` and `Debug` and the files"
    print "`error.rs` are left out: they are words (decided before the first run). A mutant that does not compile is not viable; one whose tests"
    print "need ten times their CPU time is noticed, as endless. Equivalent mutants are not counted, and listed with the reason. The score is of the tests as they stand: what survived\nearlier ones (eleven of the last 61) got a test from the law and met it."
    print ""
    print "| crate | drawn | run | not viable | equivalent | own tests | laws | tests/ | endless | missed | score |"
    print "|---|---|---|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= count; i++) {
        c = crates[i]
        printf "| %s | %d | %d | %d | %d | %d | %d | %d | %d | %d | %s |\n", c, size[c], run[c], unbuildable[c], equivalent[c], stage[c "own"], stage[c "laws"], stage[c "tests"], endless[c], viable[c] - caught[c], share_of_all(caught[c] + 0, size[c] - unbuildable[c] - equivalent[c], run[c] + 0, size[c])
        drawn += size[c]
    }
    printf "| **all** | %d | %d | %d | %d | | | | | %d | %s |\n", drawn, all_run, all_unbuildable, all_equivalent, all_viable - all_caught, share_of_all(all_caught + 0, drawn - all_unbuildable - all_equivalent, all_run + 0, drawn)
    print ""
    if (all_run < drawn) printf "%d of the sample have not been run yet: `tests/mutants/run sample` goes on. A survivor for which a test was written has no result until it has met that test: shares of unfinished parts, also of the scale faults, are too high.\n\n", drawn - all_run
    if (missed != "") print "Missed:\n\n" missed
    if (reasons != "") print "Equivalent:\n\n" reasons
}
