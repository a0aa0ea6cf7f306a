// WorkBudget: keeps work that is repeated while a render runs to a share of the program's CPU time.
#pragma once

namespace montelux {

class WorkBudget {
  public:
    // `share`: above 0.
    explicit WorkBudget(double share) : share_(share) {}

    // `cpu_seconds`: of the program so far.
    bool allows_work(double cpu_seconds) const { return cpu_seconds >= next_; }
    // After work that took `seconds`, which are part of them.
    void spend(double seconds, double cpu_seconds) { next_ = cpu_seconds + seconds / share_; }

  private:
    double share_, next_ = 0;
};

} // namespace montelux
