// Finding the library; messages where it is not found.
#include "test/denoise/denoise_testing.h"
#include "test/temporary_folder.h"
#include <cstdlib>
#include <filesystem>

#include "montelux/denoise/oidn_api.h"

namespace montelux::denoise_testing {

namespace {

// Sets the variable and puts back what it was.
class WithLibrary {
  public:
    explicit WithLibrary(const std::string& file) {
        if (const char* old = std::getenv(oidn_library_variable)) old_ = old;
        setenv(oidn_library_variable, file.c_str(), 1);
    }
    ~WithLibrary() {
        if (old_)
            setenv(oidn_library_variable, old_->c_str(), 1);
        else
            unsetenv(oidn_library_variable);
    }
    WithLibrary(const WithLibrary&) = delete;
    WithLibrary& operator=(const WithLibrary&) = delete;

  private:
    std::optional<std::string> old_;
};

std::string error_with(const std::string& file) {
    WithLibrary set(file);
    return error_of([] { load_oidn(); });
}

TEST(OidnLibrary, AFileThatIsNotThereIsNamedAndNoOtherIsTaken) {
    std::string message = error_with("/nowhere/libOpenImageDenoise.so.2");
    EXPECT_NE(message.find("MONTELUX_OIDN_LIBRARY"), std::string::npos) << message;
    EXPECT_NE(message.find("'/nowhere/libOpenImageDenoise.so.2'"), std::string::npos) << message;
    EXPECT_NE(message.find("No such file"), std::string::npos) << message;
}

TEST(OidnLibrary, AFileThatIsNoLibraryIsRefused) {
    const TemporaryFolder folder;
    const auto file = folder.write("not_a_library.so", "this is text\n");
    std::string message = error_with(file.string());
    EXPECT_NE(message.find("cannot be loaded from"), std::string::npos) << message;
}

TEST(OidnLibrary, ALibraryWithoutTheFunctionsIsRefused) {
    std::string message = error_with("libm.so.6");
    EXPECT_EQ(message,
              "libm.so.6: this is not Open Image Denoise 1.4 or newer: it has no function oidnNewDevice");
}

TEST(OidnLibrary, WithoutItTheErrorSaysHowToGetIt) {
    WithLibrary unset(""); // counts as not set
    std::string message = error_of([] { load_oidn(); });
    if (message.empty())
        GTEST_SKIP() << "the system has the library, or an earlier test of this process loaded it";
    for (const char* text : {"libOpenImageDenoise.so.2", "pip install pyoidn", "MONTELUX_OIDN_LIBRARY",
                             "pyoidn/oidn/lib/libOpenImageDenoise.so.2"})
        EXPECT_NE(message.find(text), std::string::npos) << message;
}

} // namespace

} // namespace montelux::denoise_testing
