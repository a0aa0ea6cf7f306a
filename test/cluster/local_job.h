// Ranks that are threads of this process, with mailboxes between them.
#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "montelux/cluster/mailbox.h"

namespace montelux::testing {

class LocalJob {
  public:
    explicit LocalJob(int size) {
        for (int r = 0; r < size; ++r) ranks_.push_back(std::make_unique<Rank>(*this, r));
    }
    Mailbox& mailbox(int rank) { return *ranks_[static_cast<std::size_t>(rank)]; }

  private:
    class Rank final : public Mailbox {
      public:
        Rank(LocalJob& job, int rank) : job_(job), rank_(rank) {}
        int rank() const override { return rank_; }
        int size() const override { return static_cast<int>(job_.ranks_.size()); }
        void send(int to, int tag, std::vector<std::uint8_t> bytes) override {
            Rank& other = *job_.ranks_[static_cast<std::size_t>(to)];
            std::lock_guard lock(other.mutex_);
            other.messages_.push_back({rank_, tag, std::move(bytes)});
        }
        std::optional<Message> receive() override {
            std::lock_guard lock(mutex_);
            if (messages_.empty()) return std::nullopt;
            Message m = std::move(messages_.front());
            messages_.pop_front();
            return m;
        }

      private:
        LocalJob& job_;
        int rank_;
        std::mutex mutex_;
        std::deque<Message> messages_;
    };
    std::vector<std::unique_ptr<Rank>> ranks_;
};

// A mailbox that drops the messages of its rank after the n-th one of a kind, or of any kind.
class FailingMailbox final : public Mailbox {
  public:
    FailingMailbox(Mailbox& mailbox, std::optional<int> last, int n)
        : mailbox_(mailbox), last_(last), left_(n) {}
    int rank() const override { return mailbox_.rank(); }
    int size() const override { return mailbox_.size(); }
    void send(int to, int tag, std::vector<std::uint8_t> bytes) override {
        if (left_ <= 0) return;
        mailbox_.send(to, tag, std::move(bytes));
        left_ -= tag == last_.value_or(tag);
    }
    std::optional<Message> receive() override { return mailbox_.receive(); }
    bool failed() const { return left_ <= 0; }

  private:
    Mailbox& mailbox_;
    std::optional<int> last_;
    int left_;
};

// A mailbox whose first message can be waited for.
class SpeakingMailbox final : public Mailbox {
  public:
    explicit SpeakingMailbox(Mailbox& mailbox) : mailbox_(mailbox) {}
    int rank() const override { return mailbox_.rank(); }
    int size() const override { return mailbox_.size(); }
    void send(int to, int tag, std::vector<std::uint8_t> bytes) override {
        mailbox_.send(to, tag, std::move(bytes));
        spoke_ = true;
        spoke_.notify_all();
    }
    std::optional<Message> receive() override { return mailbox_.receive(); }
    // Returns once a message was sent.
    void wait() const { spoke_.wait(false); }

  private:
    Mailbox& mailbox_;
    std::atomic<bool> spoke_{false};
};

} // namespace montelux::testing
